//! What a run met.

use darboux::Report;

use crate::room::with;

/// The report of the last run: where its numbers lie, in the order of `report` in `lib/darboux.ts`.
#[unsafe(no_mangle)]
pub extern "C" fn report() -> *const f64 {
    with(|room| {
        let Report {
            triangles,
            unsupported_faces,
            degenerate_triangles,
            uv_degenerate_triangles,
            non_finite_corners,
            repaired_corners,
            mixed_sign_faces,
            mirrored_edges,
            split_vertices,
            merged_vertices,
            ..
        } = room.tangents.report;
        let counts = [
            triangles,
            unsupported_faces,
            degenerate_triangles,
            uv_degenerate_triangles,
            non_finite_corners,
            repaired_corners,
            mixed_sign_faces,
            mirrored_edges,
            split_vertices,
            merged_vertices,
        ];
        room.values.measures.clear();
        room.values.measures.extend(counts.map(|count| count as f64));
        room.values.measures.as_ptr()
    })
}

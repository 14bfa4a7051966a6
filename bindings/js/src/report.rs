//! The report of a run: counts of what the mesh contains.

use darboux::Report;

use crate::arena::with_arena;

/// Returns the address of the last run's counts, in the order of `COUNTS` in `lib/core/full.ts`.
#[unsafe(no_mangle)]
pub extern "C" fn report() -> *const f64 {
    with_arena(|arena| {
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
        } = arena.report;
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
        arena.extras.numbers.clear();
        arena.extras.numbers.extend(counts.map(|count| count as f64));
        arena.extras.numbers.as_ptr()
    })
}

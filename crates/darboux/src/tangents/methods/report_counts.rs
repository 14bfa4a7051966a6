//! Counts for reports: mirrored edges, supported faces and non-finite corners, from packed arrays.

use crate::Mesh;

use crate::exec::limits::RunLimits;
use crate::exec::threads::{self, split_range};
use crate::tangents::Report;
use crate::tangents::methods::mesh_slices::MeshSlices;
use crate::tangents::methods::uv_derivatives::Orientation;
use crate::tangents::report;

/// The counts that do not depend on the method.
pub(crate) fn count_irregular(mesh: &Mesh<'_>, slices: &MeshSlices<'_>, limits: RunLimits<'_>) -> Report {
    count_irregular_where(mesh, slices, has_finite_vertices(slices, limits))
}

/// As [`count_irregular`]. `is_finite`: true when all positions, normals and UVs are known to be finite.
pub(crate) fn count_irregular_where(mesh: &Mesh<'_>, slices: &MeshSlices<'_>, is_finite: bool) -> Report {
    let is_supported = |face: &usize| matches!(slices.corners(*face).len(), 3 | 4);
    let supported = if slices.is_triangles() {
        slices.face_count()
    } else {
        (0..slices.face_count()).filter(is_supported).count()
    };
    Report {
        triangles: slices.triangles().len(),
        unsupported_faces: slices.face_count() - supported,
        non_finite_corners: if is_finite { 0 } else { report::count_non_finite_corners(mesh) },
        ..Report::default()
    }
}

pub(crate) fn has_finite_vertices(slices: &MeshSlices<'_>, limits: RunLimits<'_>) -> bool {
    all_finite(slices.positions.as_flattened(), limits)
        && has_finite_normals(slices, limits)
        && all_finite(slices.uvs.as_flattened(), limits)
}

pub(crate) fn has_finite_normals(slices: &MeshSlices<'_>, limits: RunLimits<'_>) -> bool {
    all_finite(slices.normals.as_flattened(), limits)
}

fn all_finite(values: &[f32], limits: RunLimits<'_>) -> bool {
    let threads = limits.thread_count(values.len() / 8);
    let mut found = vec![true; threads];
    threads::run(&mut found, split_range(0..values.len(), threads, 1), |finite, range| {
        // The maximum of the bits as integers: a loop that vectorises.
        let values = values[range].iter().map(|x| (x.to_bits() & 0x7fff_ffff) as i32);
        *finite = f32::from_bits(values.fold(0, i32::max) as u32).is_finite();
    });
    found.into_iter().all(|finite| finite)
}

/// For each vertex: true when faces of both orientations meet there. `None` when the mesh has one orientation
/// only.
pub(crate) fn vertices_of_both(
    slices: &MeshSlices<'_>,
    orientation_of_face: &[Orientation],
) -> Option<Vec<bool>> {
    // The bitmask of the orientations that occur: a loop that vectorises.
    let found = orientation_of_face.iter().fold(0, |found, &orientation| found | 1u8 << orientation as u8);
    if found & 3 != 3 {
        return None;
    }
    let mut seen = vec![0u8; slices.positions.len()];
    for (face, &orientation) in orientation_of_face.iter().enumerate() {
        let mark = [1, 2, 0][orientation as usize];
        slices.vertex_of_corner[slices.corners(face)].iter().for_each(|&v| seen[v as usize] |= mark);
    }
    Some(seen.into_iter().map(|seen| seen == 3).collect())
}

/// The number of edges between two triangles of opposite orientation. Edges connect vertices of the mesh,
/// which are not welded.
///
/// `of_both`: the result of [`vertices_of_both`].
pub(crate) fn count_mirrored_edges(
    slices: &MeshSlices<'_>,
    orientation_of_face: &[Orientation],
    of_both: &[bool],
) -> usize {
    let mut edges: Vec<([u32; 2], bool, Orientation)> = Vec::new();
    for (t, triangle) in slices.triangles().iter().enumerate() {
        let orientation = orientation_of_face[slices.face(t)];
        for k in 0..3 {
            let [a, b] = [triangle[k], triangle[(k + 1) % 3]];
            if orientation != Orientation::None && of_both[a as usize] && of_both[b as usize] && a != b {
                edges.push(([a.min(b), a.max(b)], a < b, orientation));
            }
        }
    }
    edges.sort_unstable_by_key(|&(ends, ..)| ends);
    edges.chunk_by(|a, b| a.0 == b.0).map(count_mirrored_pairs).sum()
}

/// The number of pairs along one edge that run in opposite directions and have opposite orientations.
fn count_mirrored_pairs(along: &[([u32; 2], bool, Orientation)]) -> usize {
    let count = |up, orientation| along.iter().filter(|edge| edge.1 == up && edge.2 == orientation).count();
    let (keeps, mirrors) = (Orientation::Preserves, Orientation::Mirrors);
    count(true, keeps).min(count(false, mirrors)) + count(true, mirrors).min(count(false, keeps))
}

//! Replaces the unusable tangents of a MikkTSpace run.
//!
//! The replacement is the first of these that has a direction in the tangent plane: the mean of the
//! subgroup's tangents; dP/du of the corner's triangle; any perpendicular of the normal. Without a normal it
//! is (1, 0, 0). The bitangent follows, the sign stays. Corners of one vertex with equal raw tangents share
//! one replacement, the first corner's, so that a repair never adds a split.

use crate::Mesh;
use crate::math::distinct_bits;
use crate::topology::corner_lookup::CornerLookup;
use crate::topology::triangles::Triangulation;
use crate::util::hash_map::InsertionMap;

use crate::math_f64::D3;
use crate::tangents::mikktspace::raw_frames::RawFrames;
use crate::tangents::repair::{bitangent, direction, in_plane, perpendicular, u_direction_of};

/// Replaces the tangents of `corners` in `raw`.
pub(crate) fn repair_corners(
    mesh: &Mesh<'_>,
    triangulation: &Triangulation,
    raw: &mut RawFrames,
    corners: &[u32],
) {
    if corners.is_empty() {
        return;
    }
    let lookup = CornerLookup::new(triangulation, mesh.corner_count());
    let mut welded_of_vertex = InsertionMap::new();
    let mut replacements = InsertionMap::new();
    for &corner in corners {
        let origin = lookup.get(corner);
        let vertex = mesh.vertex_of_corner(corner as usize);
        let normal = direction(mesh.normals().get(vertex));
        let own = || origin.as_ref().map_or(corner, |origin| origin.vertex);
        let welded = *welded_of_vertex.get_or_insert_with(&[vertex as u32], own);
        let frame = &mut raw.of_corner[corner as usize];
        let replacement = || {
            let Some(normal) = normal else { return [1.0, 0.0, 0.0] };
            // A corner of a quad may have the mean of another corner, which has another normal.
            let mean = in_plane(raw.mean_of_corner[corner as usize].map(f64::from), normal);
            let own =
                || origin.as_ref().and_then(|origin| in_plane(u_direction(mesh, origin.triangle), normal));
            mean.or_else(own).unwrap_or_else(|| perpendicular(normal)).map(|x| x as f32)
        };
        let [x, y, z] = distinct_bits(frame.tangent);
        let key = [welded, x, y, z, (frame.sign > 0.0).into()];
        frame.tangent = *replacements.get_or_insert_with(&key, replacement);
        frame.bitangent = bitangent(normal, frame.tangent, frame.sign);
        frame.magnitude =
            frame.magnitude.map(|magnitude| if magnitude.is_finite() { magnitude } else { 1.0 });
    }
}

/// The direction of dP/du on a triangle, not normalised. Zero or NaN where UVs or positions give none.
fn u_direction(mesh: &Mesh<'_>, corners: [u32; 3]) -> D3 {
    let vertices = corners.map(|corner| mesh.vertex_of_corner(corner as usize));
    u_direction_of(
        vertices.map(|vertex| mesh.positions().get(vertex)),
        vertices.map(|vertex| mesh.uvs().get(vertex)),
    )
}

//! Replaces unusable tangents at the corners of a MikkTSpace run.

use crate::Mesh;
use crate::math::V3;
use crate::topology::corner_lookup::CornerLookup;
use crate::topology::triangles::Triangulation;
use crate::util::hash_map::InsertionMap;

use crate::tangents::mikktspace::raw_frames::RawFrames;
use crate::tangents::repair::{D3, bitangent, direction, in_plane, perpendicular, u_direction_of};

/// Replaces what is unusable in `raw`, in place, at the corners of `needs`.
///
/// A tangent is replaced by the mean of its subgroup's; without one by its triangle's own dP/du; without that by a perpendicular of
/// the normal; without a normal by (1, 0, 0). The bitangent follows, the sign stays. Corners at one vertex whose raw tangents are equal get one
/// replacement, the first's, so that a repair never adds a split.
pub(crate) fn repair(mesh: &Mesh<'_>, triangulation: &Triangulation, raw: &mut RawFrames, needs: &[u32]) {
    if needs.is_empty() {
        return;
    }
    let places = CornerLookup::new(triangulation, mesh.corner_count());
    let mut site_of_vertex = InsertionMap::new();
    let mut known = InsertionMap::new();
    for &corner in needs {
        let place = places.of(corner);
        let vertex = mesh.vertex_of_corner(corner as usize);
        let normal = direction(mesh.normals().get(vertex));
        let own = || place.as_ref().map_or(corner, |place| place.vertex);
        let site = *site_of_vertex.first(&[vertex as u32], own);
        let frame = &mut raw.of_corner[corner as usize];
        let replacement = || {
            let Some(normal) = normal else { return [1.0, 0.0, 0.0] };
            // A corner of a quad may have its mean from another corner, with another normal.
            let mean = in_plane(raw.mean_of_corner[corner as usize].map(f64::from), normal);
            let own = || place.as_ref().and_then(|place| in_plane(u_direction(mesh, place.triangle), normal));
            mean.or_else(own).unwrap_or_else(|| perpendicular(normal)).map(|x| x as f32)
        };
        let [x, y, z] = bits(frame.tangent);
        frame.tangent = *known.first(&[site, x, y, z, (frame.sign > 0.0).into()], replacement);
        frame.bitangent = bitangent(normal, frame.tangent, frame.sign);
        frame.magnitude =
            frame.magnitude.map(|magnitude| if magnitude.is_finite() { magnitude } else { 1.0 });
    }
}

/// Bits for comparing: every NaN is one.
fn bits(v: V3) -> [u32; 3] {
    v.map(|x| if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() })
}

/// The direction of dP/du on a triangle, as long as it may be; zero or NaN where UVs or positions give none.
fn u_direction(mesh: &Mesh<'_>, corners: [u32; 3]) -> D3 {
    let vertices = corners.map(|corner| mesh.vertex_of_corner(corner as usize));
    u_direction_of(
        vertices.map(|vertex| mesh.positions().get(vertex)),
        vertices.map(|vertex| mesh.uvs().get(vertex)),
    )
}

//! [`crossing_triangles`]: where the rays of neighbouring texels cross before they reach the low surface.

use crate::LowSurface;
use crate::vector::{Vector, add_scaled, cross, dot, sub, unit, wide};

/// For each low surface, the number of triangles whose rays cross between their origins and the triangle: the
/// triangle of the origins is flipped. Details of the high surface appear mirrored there, or twice.
///
/// `outwards`: how far outside rays begin on surfaces without a cage, in units of the positions.
pub fn crossing_triangles(low: &[LowSurface<'_>], outwards: f32) -> Vec<usize> {
    let crosses = |surface: &LowSurface<'_>, triangle: usize| {
        let vertices = [0, 1, 2].map(|corner| surface.mesh.vertex_of_corner(3 * triangle + corner));
        let positions = vertices.map(|vertex| wide(surface.mesh.positions().get(vertex)));
        let origin = |corner: usize| match surface.cage {
            Some(cage) => wide(cage.get(vertices[corner])),
            None => {
                let normal = unit(wide(surface.mesh.normals().get(vertices[corner]))).unwrap_or_default();
                add_scaled(positions[corner], f64::from(outwards), normal)
            }
        };
        let origins = [0, 1, 2].map(origin);
        matches!((plane(positions), plane(origins)), (Some(low), Some(far)) if dot(low, far) < 0.0)
    };
    low.iter()
        .map(|surface| (0..surface.triangle_count()).filter(|&triangle| crosses(surface, triangle)).count())
        .collect()
}

/// The unit normal of a triangle; none without an area.
fn plane([a, b, c]: [Vector; 3]) -> Option<Vector> {
    unit(cross(sub(b, a), sub(c, a)))
}

//! A triangle of a low surface with all that samples on it need, and points on it.

use crate::LowSurface;
use crate::layout::{Layout, Placed};
use crate::vector::{Vector, cross, scale, sub, unit, weighted, wide};

/// A triangle of a low surface.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    pub placed: Placed,
    pub group: usize,
    positions: [[f32; 3]; 3],
    normals: [[f32; 3]; 3],
    tangents: [[f32; 4]; 3],
    /// w * cross(N, T) at the corners.
    bitangents: [[f32; 3]; 3],
    cage: Option<[[f32; 3]; 3]>,
    texels: [[f64; 2]; 3],
    /// Twice the signed area in texels.
    area: f64,
    /// The unit normal of the plane, counter-clockwise; zero where the triangle has no area.
    face_normal: Vector,
}

/// A point on a low surface. The interpolated vectors are not normalised, as in a renderer's fragment shader.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    pub position: Vector,
    pub normal: Vector,
    pub tangent: Vector,
    /// The interpolated sign w.
    pub sign: f64,
    /// The interpolated bitangents of the corners.
    pub bitangent: Vector,
    /// The point of the cage, if there is one.
    pub cage: Option<Vector>,
    /// The unit normal of the triangle's plane, counter-clockwise; zero where the triangle has no area.
    pub face_normal: Vector,
}

impl Face {
    pub fn new(layout: &Layout, surfaces: &[LowSurface<'_>], placed: Placed) -> Self {
        let low = &surfaces[placed.surface as usize];
        let corners = [0, 1, 2].map(|corner| 3 * placed.triangle as usize + corner);
        let vertices = corners.map(|corner| low.mesh.vertex_of_corner(corner));
        let normals = vertices.map(|vertex| low.mesh.normals().get(vertex));
        let tangents = corners.map(|corner| low.tangents[corner]);
        let positions = vertices.map(|vertex| low.mesh.positions().get(vertex));
        let texels = layout.texels(low, &placed);
        let [a, b, c] = positions.map(wide);
        Self {
            placed,
            group: low.group,
            positions,
            normals,
            tangents,
            bitangents: [0, 1, 2].map(|i| bitangent(normals[i], tangents[i])),
            cage: low.cage.map(|cage| vertices.map(|vertex| cage.get(vertex))),
            texels,
            area: area(texels),
            face_normal: unit(cross(sub(b, a), sub(c, a))).unwrap_or_default(),
        }
    }

    /// The point at a place of the image, in texels. A place outside the triangle, where rounding has put it, moves to its edge.
    pub fn point(&self, at: [f64; 2]) -> SurfacePoint {
        let weights = self.weights(at);
        let [x, y, z, sign] = weighted(weights, self.tangents);
        SurfacePoint {
            position: weighted(weights, self.positions),
            normal: weighted(weights, self.normals),
            tangent: [x, y, z],
            sign,
            bitangent: weighted(weights, self.bitangents),
            cage: self.cage.map(|cage| weighted(weights, cage)),
            face_normal: self.face_normal,
        }
    }

    /// The barycentric coordinates of a place, none of them negative.
    fn weights(&self, at: [f64; 2]) -> [f64; 3] {
        let [a, b, c] = self.texels;
        if self.area == 0.0 {
            return [1.0 / 3.0; 3];
        }
        let parts = [area([at, b, c]), area([a, at, c]), area([a, b, at])];
        let weights = parts.map(|part| (part / self.area).max(0.0));
        scale(1.0 / weights.iter().sum::<f64>(), weights)
    }
}

/// Twice the signed area of a triangle.
fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// w * cross(N, T).
fn bitangent(normal: [f32; 3], [x, y, z, w]: [f32; 4]) -> [f32; 3] {
    scale(f64::from(w), cross(wide(normal), wide([x, y, z]))).map(|x| x as f32)
}

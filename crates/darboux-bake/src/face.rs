//! A triangle of a low surface with all that samples on it need, and points on it.

use crate::layout::{Layout, TileTriangle};
use crate::point::SurfacePoint;
use crate::vector::{Vector, cross, mixture, narrow, scale, sub, unit, wide};
use crate::{LowSurface, SkewCorrection};

/// A triangle of a low surface.
#[derive(Clone, Debug)]
pub struct Face<'a> {
    pub triangle: TileTriangle,
    pub group: usize,
    positions: [Vector; 3],
    normals: [Vector; 3],
    tangents: [[f64; 4]; 3],
    /// w * cross(N, T) at the corners.
    bitangents: [Vector; 3],
    cage: Option<[Vector; 3]>,
    texels: [[f64; 2]; 3],
    /// Twice the signed area in texels.
    area: f64,
    /// The unit normal of the plane, counter-clockwise; zero where the triangle has no area.
    face_normal: Vector,
    skew: Option<SkewCorrection<'a>>,
    /// The size of the image in texels.
    size: [f64; 2],
}

/// The faces that samples met last, each at a place that its triangle's number chooses.
#[derive(Debug)]
pub struct Faces<'a> {
    faces: Vec<Option<Face<'a>>>,
}

impl<'a> Faces<'a> {
    /// Around a tile of texels there are seldom more triangles.
    const PLACES: usize = 16;

    pub fn new() -> Self {
        Self { faces: vec![None; Self::PLACES] }
    }

    /// The face of a triangle.
    pub fn get(&mut self, layout: &Layout, low: &[LowSurface<'a>], triangle: TileTriangle) -> &Face<'a> {
        let place = &mut self.faces[triangle.index as usize % Self::PLACES];
        if place.as_ref().is_some_and(|face| face.triangle != triangle) {
            *place = None;
        }
        place.get_or_insert_with(|| Face::new(layout, low, triangle))
    }
}

impl<'a> Face<'a> {
    pub fn new(layout: &Layout, surfaces: &[LowSurface<'a>], triangle: TileTriangle) -> Self {
        let low = &surfaces[triangle.surface as usize];
        let corners = [0, 1, 2].map(|corner| 3 * triangle.index as usize + corner);
        let vertices = corners.map(|corner| low.mesh.vertex_of_corner(corner));
        let normals = vertices.map(|vertex| wide(low.mesh.normals().get(vertex)));
        let tangents = corners.map(|corner| low.tangents[corner].map(f64::from));
        let positions = vertices.map(|vertex| wide(low.space.position(low.mesh.positions().get(vertex))));
        let texels = layout.texels(low, &triangle);
        let [a, b, c] = positions;
        Self {
            triangle,
            group: low.group,
            positions,
            normals,
            tangents,
            bitangents: [0, 1, 2].map(|i| bitangent(normals[i], tangents[i])),
            cage: low.cage.map(|cage| vertices.map(|vertex| wide(low.space.position(cage.get(vertex))))),
            texels,
            area: area(texels),
            face_normal: unit(cross(sub(b, a), sub(c, a))).unwrap_or_default(),
            skew: low.skew,
            size: layout.size.map(|side| side as f64),
        }
    }

    /// The sides of a texel on the surface: how the position changes along the columns and rows of the image.
    pub fn sides_of_texel(&self) -> [Vector; 2] {
        if self.area == 0.0 {
            return [[0.0; 3]; 2];
        }
        let [a, b, c] = self.texels;
        let of_axis = |i: usize| {
            // The weights of the corners are linear in the place.
            let sign = if i == 0 { 1.0 } else { -1.0 };
            let other = 1 - i;
            let weights = [b[other] - c[other], c[other] - a[other], a[other] - b[other]];
            mixture(weights.map(|weight| sign * weight / self.area), self.positions)
        };
        [of_axis(0), of_axis(1)]
    }

    /// The distance of a place in texels from the nearest of the triangle's edges, as lines.
    pub fn distance_to_edges(&self, at: [f64; 2]) -> f64 {
        let [a, b, c] = self.texels;
        let distance = |[p, q]: [[f64; 2]; 2]| {
            let [x, y] = [q[0] - p[0], q[1] - p[1]];
            area([p, q, at]).abs() / (x * x + y * y).sqrt().max(f64::MIN_POSITIVE)
        };
        [[a, b], [b, c], [c, a]].map(distance).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The point at a place of the image, in texels. A place outside the triangle, where rounding has put it,
    /// moves to its edge.
    pub fn point(&self, at: [f64; 2]) -> SurfacePoint {
        let weights = self.continued_weights(at).map(|weight| weight.max(0.0));
        self.mixed(scale(1.0 / weights.iter().sum::<f64>(), weights), at)
    }

    /// The point at a place outside the triangle, where its plane, cage and frames are continued; `None`
    /// farther away than the triangle is large, where errors would grow.
    pub fn continued_point(&self, at: [f64; 2]) -> Option<SurfacePoint> {
        let weights = self.continued_weights(at);
        weights.iter().all(|weight| (-1.0..=2.0).contains(weight)).then(|| self.mixed(weights, at))
    }

    fn mixed(&self, weights: [f64; 3], at: [f64; 2]) -> SurfacePoint {
        let [x, y, z, sign] = mixture(weights, self.tangents);
        SurfacePoint {
            position: mixture(weights, self.positions),
            normal: mixture(weights, self.normals),
            tangent: [x, y, z],
            sign,
            bitangent: mixture(weights, self.bitangents),
            cage: self.cage.map(|cage| mixture(weights, cage)),
            face_normal: self.face_normal,
            skew: self.skew_at(at),
        }
    }

    fn skew_at(&self, at: [f64; 2]) -> f64 {
        let share = || [0, 1].map(|i| at[i] / self.size[i]);
        self.skew.map_or(0.0, |skew| skew.at(self.triangle.index as usize, share()))
    }

    /// The barycentric coordinates of a place; some are negative outside the triangle.
    fn continued_weights(&self, at: [f64; 2]) -> [f64; 3] {
        let [a, b, c] = self.texels;
        if self.area == 0.0 {
            return [1.0 / 3.0; 3];
        }
        let parts = [area([at, b, c]), area([a, at, c]), area([a, b, at])];
        parts.map(|part| part / self.area)
    }
}

/// Twice the signed area of a triangle.
fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// w * cross(N, T).
fn bitangent(normal: Vector, [x, y, z, w]: [f64; 4]) -> Vector {
    wide(narrow(scale(w, cross(normal, [x, y, z]))))
}

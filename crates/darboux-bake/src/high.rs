//! The high surfaces of a group, with the hierarchy that finds hits on them.

use darboux::Context;

use crate::bvh::{Bvh, Hit};
use crate::limits::MAX_TRIANGLES;
use crate::vector::{Vector, cross, dot, scale, sub, unit, weighted, wide};
use crate::{BakeError, HighSurface};

/// The high surfaces of one group.
pub struct HighGroup<'a> {
    surfaces: Vec<HighSurface<'a>>,
    /// The number of the first triangle of every surface.
    starts: Vec<u32>,
    pub bvh: Bvh,
    /// The number of triangles with corners that are not finite.
    pub non_finite: usize,
}

/// The high surface at a hit.
#[derive(Clone, Copy, Debug)]
pub struct HighPoint {
    /// The place of the surface in its group.
    pub surface: usize,
    pub triangle: usize,
    /// The normal from the surface's map, or else the interpolated normal, or the normal of the triangle's
    /// plane; unit length.
    pub normal: Vector,
    /// The normal of the triangle's plane, towards the ray's origin; not normalised, not zero.
    pub face_normal: Vector,
    /// Whether the interpolated normal points to the back of its triangle.
    pub is_inverted: bool,
}

impl<'a> HighGroup<'a> {
    /// Builds the hierarchy over the surfaces of a group. Errors: too many triangles; the context's token was
    /// cancelled.
    pub fn new(all: &[HighSurface<'a>], group: usize, context: &Context) -> Result<Self, BakeError> {
        let surfaces: Vec<_> = all.iter().filter(|surface| surface.group == group).copied().collect();
        let count: u64 = surfaces.iter().map(|surface| surface.triangle_count() as u64).sum();
        if count > MAX_TRIANGLES {
            return Err(BakeError::TooManyTriangles { found: count });
        }
        let mut starts = Vec::new();
        let mut next = 0;
        for surface in &surfaces {
            starts.push(next);
            next += surface.triangle_count() as u32;
        }
        let corners = |triangle: u32| {
            let (surface, triangle) = find(&starts, triangle);
            surfaces[surface].corners(surfaces[surface].vertices(triangle))
        };
        let bvh = Bvh::build(count as u32, &corners, context)?;
        let non_finite = count as usize - bvh.triangle_count();
        Ok(Self { surfaces, starts, bvh, non_finite })
    }

    /// The surface at a hit. With back faces the normal is turned to the side from which the ray came.
    pub fn point(&self, hit: &Hit) -> Option<HighPoint> {
        let (place, triangle) = find(&self.starts, hit.triangle);
        let surface = &self.surfaces[place];
        let vertices = surface.vertices(triangle);
        let [a, b, c] = surface.corners(vertices).map(wide);
        let side = if hit.is_front { 1.0 } else { -1.0 };
        let plane = cross(sub(b, a), sub(c, a));
        let square = dot(plane, plane);
        if !(square > 0.0 && square.is_finite()) {
            return None;
        }
        let weights = hit.weights.map(f64::from);
        let interpolated = weighted(weights, surface.normals(vertices));
        let (outwards, smooth) = match unit(interpolated) {
            Some(unit) => (interpolated, unit),
            None => (unit(plane)?, unit(plane)?),
        };
        let is_inverted = dot(outwards, plane) < 0.0;
        let normal = surface.mapped_normal(triangle, weights, outwards).unwrap_or(smooth);
        let face_normal = scale(side, plane);
        let normal = scale(side, normal);
        Some(HighPoint { surface: place, triangle, normal, face_normal, is_inverted })
    }

    /// The surface of a point.
    pub fn surface(&self, point: &HighPoint) -> &HighSurface<'a> {
        &self.surfaces[point.surface]
    }

    /// Whether a triangle belongs to a part.
    pub fn is_of_part(&self, triangle: u32, part: u32) -> bool {
        self.surfaces[find(&self.starts, triangle).0].labels.part == part
    }
}

/// The surface and the place in it of a triangle of a group.
fn find(starts: &[u32], triangle: u32) -> (usize, usize) {
    let surface = starts.partition_point(|&start| start <= triangle) - 1;
    (surface, (triangle - starts[surface]) as usize)
}

//! Curvature: the mean curvature of the high surface within a radius, times the radius. A sphere of the same
//! radius has 1, a bowl -1.
//!
//! In [`COUNT`] planes through the normal n at a point p, a walk around a square finds the next point q of
//! the surface, with the normal m:
//!
//! ```text
//! up by the radius, outwards by the radius, down by twice the radius, back below p, up to p
//! curvature in the plane = (m - n) . (q - p) / |q - p|^2
//! ```
//!
//! This quotient is exact on spheres for every radius, and its mean over evenly spaced planes is the mean
//! curvature where the radius is small. The walk finds the second side also at edges and in corners, where a
//! ray from above would miss it.

use super::hemisphere::lifted;
use crate::CurvatureRadius;
use crate::bvh::{Ray, Sides, Stack};
use crate::found::Found;
use crate::vector::{Vector, add_scaled, cross, dot, length, narrow, perpendiculars, scale, sub, unit, wide};

/// Directions around a point.
const COUNT: u32 = 16;

/// The mean curvature times the radius.
pub fn mean(found: &Found<'_>, stack: &mut Stack) -> f64 {
    let radius = radius(found);
    if !(radius > 0.0 && radius.is_finite()) {
        return 0.0;
    }
    let normal = found.high.normal;
    let outwards = unit(found.high.face_normal).unwrap_or(normal);
    let walk = Walk { found, origin: wide(lifted(found, outwards)), radius };
    let ceiling = walk.first(walk.origin, normal, radius, stack).map_or(radius, |hit| 0.5 * hit.distance);
    let [x, y] = perpendiculars(normal);
    let sum: f64 = (0..COUNT)
        .map(|turn| {
            let (sin, cos) = super::hemisphere::sine_and_cosine(
                std::f64::consts::TAU * f64::from(turn) / f64::from(COUNT),
            );
            let along = [0, 1, 2].map(|i| cos * x[i] + sin * y[i]);
            walk.curvature(along, ceiling, stack)
        })
        .sum();
    radius * sum / f64::from(COUNT)
}

/// The radius in the common box.
fn radius(found: &Found<'_>) -> f64 {
    match found.options.curvature_radius {
        CurvatureRadius::Distance(distance) => f64::from(distance),
        CurvatureRadius::Texels(texels) => {
            let [a, b] = found.low.sides;
            let per_axis = f64::from(found.options.samples_per_axis);
            f64::from(texels) * per_axis * length(cross(a, b)).sqrt()
        }
    }
}

struct Walk<'a> {
    found: &'a Found<'a>,
    origin: Vector,
    radius: f64,
}

/// A hit of a walk.
struct WalkHit {
    distance: f64,
    position: Vector,
    normal: Vector,
}

impl Walk<'_> {
    /// The curvature in the plane of the normal and a direction; 0 where the walk finds nothing.
    fn curvature(&self, along: Vector, ceiling: f64, stack: &mut Stack) -> f64 {
        let (normal, radius) = (self.found.high.normal, self.radius);
        let (down, back) = (scale(-1.0, normal), scale(-1.0, along));
        let above = add_scaled(self.origin, ceiling, normal);
        let outside = add_scaled(above, radius, along);
        let below = add_scaled(outside, ceiling + radius, down);
        let under = add_scaled(below, radius, back);
        let legs = [
            (above, along, radius),
            (outside, down, ceiling + radius),
            (below, back, radius),
            (under, normal, radius),
        ];
        let hit = legs.into_iter().find_map(|(from, along, length)| self.first(from, along, length, stack));
        hit.map_or(0.0, |hit| self.between(&hit))
    }

    /// The curvature between the point and a hit. A hit nearer than a hundredth of the radius is the point
    /// itself.
    fn between(&self, hit: &WalkHit) -> f64 {
        let apart = sub(hit.position, self.found.position);
        let square = dot(apart, apart);
        let least = 0.01 * self.radius;
        if square < least * least {
            return 0.0;
        }
        let turn = dot(sub(hit.normal, self.found.high.normal), apart);
        (turn / square).clamp(-2.0 / self.radius, 2.0 / self.radius)
    }

    fn first(&self, from: Vector, along: Vector, length: f64, stack: &mut Stack) -> Option<WalkHit> {
        let ray = Ray { origin: narrow(from), direction: narrow(along), length: length as f32 };
        let group = self.found.group;
        let hit = group.bvh.nearest(&ray, Sides::Both, stack)?;
        let point = group.point(&hit)?;
        // The normal to the outside, whichever side was hit.
        let normal = if hit.is_front { point.normal } else { scale(-1.0, point.normal) };
        let distance = f64::from(hit.distance);
        Some(WalkHit { distance, position: add_scaled(from, distance, along), normal })
    }
}

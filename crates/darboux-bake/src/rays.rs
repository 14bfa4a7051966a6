//! Stage 3: the ray of a sample, from outside the low surface through it.

use crate::bvh::Ray;
use crate::point::SurfacePoint;
use crate::skew::turned;
use crate::vector::{Vector, add_scaled, length, narrow, scale, sub, unit, wide};

/// A ray, and where on it the low surface lies.
#[derive(Clone, Copy, Debug)]
pub struct SampleRay {
    pub ray: Ray,
    /// The distance of the low surface from the origin.
    pub surface: f64,
}

/// The ray of a point; `None` where neither normals nor the triangle give a direction.
///
/// Without a cage it begins at `distance[0]` outside along the normal. With a cage it begins at the cage's
/// point and passes through the surface's. It ends at `distance[1]` inside. The surface's skew correction
/// turns it.
pub fn ray_of(point: &SurfacePoint, distance: [f32; 2]) -> Option<SampleRay> {
    let [outwards, inwards] = distance.map(f64::from);
    let outwards_direction = unit(point.normal).or_else(|| unit(point.face_normal))?;
    let (origin, inwards_direction) = match point.cage {
        None => (add_scaled(point.position, outwards, outwards_direction), scale(-1.0, outwards_direction)),
        // Where the cage touches the surface, the normal decides.
        Some(cage) => (cage, unit(sub(point.position, cage)).unwrap_or(scale(-1.0, outwards_direction))),
    };
    let surface = length(sub(point.position, origin));
    if point.skew > 0.0 {
        return Some(straightened(point, surface, scale(-1.0, inwards_direction), inwards));
    }
    Some(ray_from(origin, inwards_direction, surface, inwards))
}

/// The ray of a point whose direction turns to the normal of the triangle; it begins as far outside as
/// before.
fn straightened(point: &SurfacePoint, surface: f64, outwards: Vector, inwards: f64) -> SampleRay {
    let outwards = turned(outwards, point.face_normal, point.skew);
    ray_from(add_scaled(point.position, surface, outwards), scale(-1.0, outwards), surface, inwards)
}

fn ray_from(origin: Vector, direction: Vector, surface: f64, inwards: f64) -> SampleRay {
    let ray =
        Ray { origin: narrow(origin), direction: narrow(direction), length: (surface + inwards) as f32 };
    SampleRay { ray, surface }
}

/// The point of a ray at a distance.
pub fn point_at(ray: &Ray, distance: f32) -> Vector {
    add_scaled(wide(ray.origin), f64::from(distance), wide(ray.direction))
}

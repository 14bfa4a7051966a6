//! Thickness: the mean distance, cosine-weighted over the hemisphere below the surface, to the other side.

use super::hemisphere::Directions;
use crate::OcclusionWeights;
use crate::bvh::{Ray, Stack};
use crate::found::Found;
use crate::vector::{narrow, scale, unit};

/// The mean distance. Rays that meet nothing count as the greatest distance; they do not count where it is
/// infinite, and 0 remains if there are no others.
pub fn mean(found: &Found<'_>, stack: &mut Stack) -> f64 {
    let options = found.options;
    let inwards = scale(-1.0, found.high.normal);
    let below = unit(scale(-1.0, found.high.face_normal)).unwrap_or(inwards);
    let directions = Directions::new(inwards, options.occlusion_rays, OcclusionWeights::Cosine, found.seed);
    let origin = super::hemisphere::lifted(found, below);
    let length = options.thickness_distance;
    let (mut sum, mut count) = (0.0, 0u32);
    for direction in directions.all() {
        let ray = Ray { origin, direction: narrow(direction), length };
        let distance = found.group.bvh.nearest_where(&ray, |_| true, stack).map(|hit| hit.distance);
        if let Some(distance) = distance.or(length.is_finite().then_some(length)) {
            sum += f64::from(distance);
            count += 1;
        }
    }
    sum / f64::from(count.max(1))
}

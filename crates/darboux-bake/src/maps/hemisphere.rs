//! What lies around a point of the high surface: the share of the hemisphere that is open, and the mean of
//! its open directions.

use crate::bvh::{Ray, Stack};
use crate::found::Found;
use crate::vector::{Vector, add_scaled, narrow, perpendiculars, unit};
use crate::{OcclusionFalloff, OcclusionWeights};

/// The origin of rays lies above the surface by this share of the coordinates' size, so that rounding does
/// not put it below.
const LIFT: f64 = 1e-5;

/// It lies at least this share of the largest coordinate above it: on triangles that are much larger than the
/// model, hits are rounded by as much.
const LIFT_OF_BOX: f64 = 1e-6;

/// What lies around a point.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings {
    /// From 0, closed, to 1.
    pub open: f64,
    /// The mean of the open directions, not normalised; the normal where none is open.
    pub bent: Vector,
}

impl Default for Surroundings {
    fn default() -> Self {
        Self { open: 1.0, bent: [0.0, 0.0, 1.0] }
    }
}

/// Follows the rays of a hemisphere over a hit.
pub fn look_around(found: &Found<'_>, stack: &mut Stack) -> Surroundings {
    let options = found.options;
    let (normal, count) = (found.high.normal, options.occlusion_rays);
    let face_normal = unit(found.high.face_normal).unwrap_or(normal);
    let directions = Directions::new(normal, count, options.occlusion_weights, found.seed);
    let origin = lifted(found, face_normal);
    let (mut open, mut bent) = (0.0, [0.0; 3]);
    for direction in directions.all() {
        let ray = Ray { origin, direction: narrow(direction), length: options.occlusion_distance };
        let share = openness(found, &ray, stack);
        open += share;
        bent = add_scaled(bent, share, direction);
    }
    let count = f64::from(count.max(1));
    let bent = bent.map(|x| x / count);
    Surroundings { open: open / count, bent: if open > 0.0 { bent } else { normal } }
}

/// How open the direction of a ray is, from 0 to 1.
fn openness(found: &Found<'_>, ray: &Ray, stack: &mut Stack) -> f64 {
    let part = found.group.surface(&found.high).labels.part;
    let is_part = |triangle| found.group.is_of_part(triangle, part);
    let bvh = &found.group.bvh;
    let own_part = found.options.own_part_only;
    if found.options.occlusion_falloff == OcclusionFalloff::None {
        let is_blocked =
            if own_part { bvh.is_blocked_where(ray, is_part, stack) } else { bvh.is_blocked(ray, stack) };
        return f64::from(u8::from(!is_blocked));
    }
    let hit = match own_part {
        true => bvh.nearest_where(ray, is_part, stack),
        false => bvh.nearest_where(ray, |_| true, stack),
    };
    let Some(hit) = hit else { return 1.0 };
    let share = (f64::from(hit.distance) / f64::from(ray.length)).clamp(0.0, 1.0);
    match found.options.occlusion_falloff {
        OcclusionFalloff::Quadratic => 1.0 - (1.0 - share) * (1.0 - share),
        _ => share,
    }
}

/// A point of a hit, moved away from the surface. `outwards`: of unit length.
pub fn lifted(found: &Found<'_>, outwards: Vector) -> [f32; 3] {
    let size = found.position.iter().fold(1e-30f64, |size, x| size.max(x.abs()));
    let lift = (LIFT * size).max(LIFT_OF_BOX * found.group.bvh.largest_coordinate());
    narrow(add_scaled(found.position, lift, outwards))
}

/// Directions over a hemisphere: the Hammersley set, turned by a random angle, so that errors are noise and
/// not bands.
pub struct Directions {
    axes: [Vector; 3],
    count: u32,
    weights: OcclusionWeights,
    turn: f64,
}

impl Directions {
    /// `normal`: of unit length; `seed`: chooses the angle, which differs between neighbouring samples.
    pub fn new(normal: Vector, count: u32, weights: OcclusionWeights, seed: u64) -> Self {
        let [x, y] = perpendiculars(normal);
        Self { axes: [x, y, normal], count, weights, turn: turn_of(seed) }
    }

    /// The directions. Weights by the cosine: a disc projected up (P. Shirley, K. Chiu, 1997); uniform ones:
    /// a cylinder projected inwards (Archimedes).
    pub fn all(&self) -> impl Iterator<Item = Vector> {
        let [x, y, normal] = self.axes;
        (0..self.count).map(move |index| {
            let share = (f64::from(index) + 0.5) / f64::from(self.count);
            let (radius, height) = match self.weights {
                OcclusionWeights::Cosine => {
                    let radius = share.sqrt();
                    (radius, (1.0 - radius * radius).max(0.0).sqrt())
                }
                OcclusionWeights::Uniform => ((1.0 - share * share).sqrt(), share),
            };
            let angle = std::f64::consts::TAU * (radical_inverse(index) + self.turn);
            let (sin, cos) = sine_and_cosine(angle);
            [0, 1, 2].map(|i| radius * (cos * x[i] + sin * y[i]) + height * normal[i])
        })
    }
}

/// The sine and the cosine of an angle by their Taylor series: the same bits on every platform, which
/// libraries of the system do not promise. Error: below 1e-9 for the angles here, from 0 to 4 pi.
pub fn sine_and_cosine(angle: f64) -> (f64, f64) {
    let turns = angle / std::f64::consts::TAU;
    let x = (turns - turns.round()) * std::f64::consts::TAU;
    let square = x * x;
    let series = |first: f64, from: u32| {
        let (mut term, mut sum) = (first, first);
        for step in 1..13 {
            let n = f64::from(from + 2 * step);
            term *= -square / (n * (n - 1.0));
            sum += term;
        }
        sum
    };
    (series(x, 1), series(1.0, 0))
}

/// The digits of a number in base 2, mirrored at the point.
fn radical_inverse(index: u32) -> f64 {
    f64::from(index.reverse_bits()) / 4_294_967_296.0
}

/// A number in [0, 1) (the finaliser of splitmix64).
pub fn turn_of(seed: u64) -> f64 {
    let z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_agrees_with_the_platform() {
        for step in 0..=4000 {
            let angle = f64::from(step) / 4000.0 * 2.0 * std::f64::consts::TAU;
            let (sin, cos) = sine_and_cosine(angle);
            assert!((sin - angle.sin()).abs() < 1e-9 && (cos - angle.cos()).abs() < 1e-9, "{angle}");
        }
    }
}

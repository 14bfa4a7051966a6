//! Ambient occlusion: the share of rays over the hemisphere that hit nothing, weighted by the cosine.

use crate::bvh::{Bvh, Ray, Stack};
use crate::vector::{Vector, add_scaled, narrow, perpendiculars};

/// The origin of rays lies above the surface by this share of the coordinates' size, so that rounding does not put it below.
const LIFT: f64 = 1e-5;

/// Where rays of occlusion begin, and how they are chosen.
pub struct Opening {
    pub position: Vector,
    /// Unit length.
    pub normal: Vector,
    /// The normal of the triangle's plane; unit length.
    pub face_normal: Vector,
    /// Chooses the turn of the pattern: neighbouring samples have different ones, so that errors are noise and not bands.
    pub seed: u64,
}

impl Opening {
    /// The share of `count` rays that hit nothing within `distance`.
    ///
    /// Directions are cosine-weighted (P. Shirley, K. Chiu, 1997: a disc projected up) over the Hammersley set, turned by the seed.
    pub fn share(&self, bvh: &Bvh, count: u32, distance: f32, stack: &mut Stack) -> f64 {
        let [x, y] = perpendiculars(self.normal);
        let size = self.position.iter().fold(1e-30f64, |size, x| size.max(x.abs()));
        let origin = narrow(add_scaled(self.position, LIFT * size, self.face_normal));
        let turn = turn_of(self.seed);
        let is_open = |&index: &u32| {
            let radius = ((f64::from(index) + 0.5) / f64::from(count)).sqrt();
            let angle = std::f64::consts::TAU * (radical_inverse(index) + turn);
            let height = (1.0 - radius * radius).max(0.0).sqrt();
            let (sin, cos) = sine_and_cosine(angle);
            let direction = [0, 1, 2].map(|i| radius * (cos * x[i] + sin * y[i]) + height * self.normal[i]);
            !bvh.is_blocked(&Ray { origin, direction: narrow(direction), length: distance }, stack)
        };
        (0..count).filter(is_open).count() as f64 / f64::from(count.max(1))
    }
}

/// The sine and the cosine of an angle by their Taylor series: the same bits on every platform, which libraries of the system do not promise.
/// Error: below 1e-9 for the angles here, from 0 to 4 pi.
fn sine_and_cosine(angle: f64) -> (f64, f64) {
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

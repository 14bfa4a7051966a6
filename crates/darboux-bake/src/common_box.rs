//! Brings the models into one box before rays are followed, so that products of their coordinates neither
//! overflow nor underflow.
//!
//! The factor is a power of two. Scaling is then exact, and a model that is larger or smaller by a power of
//! two has the same content, bit for bit, and heights and positions that differ by that power.

use crate::vector::wide;

/// A box around the low surfaces, scaled so that its largest coordinate lies from 1 to 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonBox {
    /// A power of two.
    factor: f64,
}

impl CommonBox {
    /// The box around positions. Coordinates that are not finite do not count; without any, nothing is
    /// scaled.
    pub fn around(positions: impl Iterator<Item = [f32; 3]>) -> Self {
        let finite = positions.flatten().filter(|x| x.is_finite());
        Self::of_largest(finite.fold(0.0, |largest, x| f64::from(x.abs()).max(largest)))
    }

    fn of_largest(largest: f64) -> Self {
        // Positions are 32-bit numbers, so in 64 bits this one is normal and its exponent stands alone.
        let exponent = (largest.to_bits() >> 52) as i64 - 1023;
        let factor = if largest > 0.0 { f64::from_bits(((1023 - exponent) as u64) << 52) } else { 1.0 };
        Self { factor }
    }

    /// A place in the box.
    pub fn position(self, place: [f32; 3]) -> [f32; 3] {
        wide(place).map(|x| (self.factor * x) as f32)
    }

    /// A distance in the box. What would overflow is as long as a number can be.
    pub fn distance(self, distance: f32) -> f32 {
        let scaled = (self.factor * f64::from(distance)) as f32;
        if distance.is_finite() { scaled.min(f32::MAX) } else { scaled }
    }

    /// A distance or coordinate of the box in the unit of the models.
    pub fn restored(self, x: f64) -> f64 {
        x / self.factor
    }
}

impl Default for CommonBox {
    fn default() -> Self {
        Self { factor: 1.0 }
    }
}

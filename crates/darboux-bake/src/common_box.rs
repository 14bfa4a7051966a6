//! Brings the models into one box before rays are followed, so that products of their coordinates neither overflow nor underflow.
//!
//! The factor is a power of two. Scaling is then exact, and a model that is larger or smaller by a power of two has the same content, bit for bit, and
//! heights and positions that differ by that power.

use darboux::Strided;

use crate::vector::wide;
use crate::{BakeOptions, HighSurface, LowSurface};

/// A box around the low surfaces, scaled so that its largest coordinate lies from 1 to 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonBox {
    /// A power of two.
    factor: f64,
}

impl CommonBox {
    /// The box of the places that the triangles of the low surfaces use. Coordinates that are not finite do not count; without any, nothing is scaled.
    pub fn around(low: &[LowSurface<'_>]) -> Self {
        let largest = low.iter().map(|surface| {
            let mesh = &surface.mesh;
            let used = (0..mesh.corner_count()).map(|corner| mesh.vertex_of_corner(corner));
            largest(used.map(|vertex| mesh.positions().get(vertex)))
        });
        Self::of_largest(largest.fold(0.0, f64::max))
    }

    /// The box of positions.
    pub fn of_positions(positions: Strided<'_, 3>) -> Self {
        Self::of_largest(largest((0..positions.len()).map(|vertex| positions.get(vertex))))
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
    fn distance(self, distance: f32) -> f32 {
        let scaled = (self.factor * f64::from(distance)) as f32;
        if distance.is_finite() { scaled.min(f32::MAX) } else { scaled }
    }

    /// A distance or coordinate of the box in the unit of the models.
    pub fn restored(self, x: f64) -> f64 {
        x / self.factor
    }

    /// The surfaces, which give their corners in the box.
    pub fn low<'a>(self, surfaces: &[LowSurface<'a>]) -> Vec<LowSurface<'a>> {
        surfaces.iter().map(|surface| surface.in_space(self)).collect()
    }

    /// The surfaces, which give their corners in the box.
    pub fn high<'a>(self, surfaces: &[HighSurface<'a>]) -> Vec<HighSurface<'a>> {
        surfaces.iter().map(|surface| surface.in_space(self)).collect()
    }

    /// The options with their distances in the box.
    pub fn options(self, options: &BakeOptions) -> BakeOptions {
        let distance = options.distance.map(|distance| self.distance(distance));
        BakeOptions { distance, occlusion_distance: self.distance(options.occlusion_distance), ..*options }
    }
}

impl Default for CommonBox {
    fn default() -> Self {
        Self { factor: 1.0 }
    }
}

/// The largest absolute coordinate of those that are finite.
fn largest(positions: impl Iterator<Item = [f32; 3]>) -> f64 {
    let finite = |x: &f32| x.is_finite();
    positions.flatten().filter(finite).fold(0.0, |largest, x| f64::from(x.abs()).max(largest))
}

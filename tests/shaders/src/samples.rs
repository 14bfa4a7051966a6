//! Numbers to try, and the distance that arithmetic of a GPU may keep.

use crate::vector::{cross, doubles, length, singles, unit};

/// One unit in the last place of 1. Bounds count in it: WGSL and Vulkan let a sum or product be off by 1, a quotient by 2.5, a root by
/// 4.5 of them; contracting a product and a sum into one operation only takes from that.
pub const ULP: f64 = f32::EPSILON as f64;

/// A repeatable sequence of numbers.
pub struct Random(u64);

impl Random {
    /// The sequence of this number.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Any word.
    pub fn word(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }

    /// In [-1, 1).
    pub fn number(&mut self) -> f32 {
        self.word() as i32 as f32 / 2f32.powi(31)
    }

    /// In [0, 1).
    pub fn fraction(&mut self) -> f32 {
        0.5 + 0.5 * self.number()
    }

    /// Any direction.
    pub fn direction(&mut self) -> [f32; 3] {
        loop {
            let v = [self.number(), self.number(), self.number()];
            if (0.01..=1.0).contains(&length(doubles(v))) {
                return singles(unit(doubles(v)));
            }
        }
    }

    /// A unit normal and a tangent, unit and perpendicular to it, with a sign.
    pub fn frame(&mut self) -> ([f32; 3], [f32; 4]) {
        let normal = self.direction();
        let [x, y, z] = loop {
            let across = cross(doubles(normal), doubles(self.direction()));
            if length(across) > 0.1 {
                break singles(unit(across));
            }
        };
        (normal, [x, y, z, if self.word() & 1 == 0 { 1.0 } else { -1.0 }])
    }
}

/// Floats as the words of a sample.
pub fn bits(floats: &[f32]) -> Vec<u32> {
    floats.iter().map(|float| float.to_bits()).collect()
}

/// `N` floats of a sample, from the word at `start` on.
pub fn floats<const N: usize>(sample: &[u32], start: usize) -> [f32; N] {
    std::array::from_fn(|k| f32::from_bits(sample[start + k]))
}

/// `N` integers of a sample, from its first word on.
pub fn integers<const N: usize>(sample: &[u32]) -> [i32; N] {
    std::array::from_fn(|k| sample[k] as i32)
}

/// `count` samples of floats.
pub fn many(count: usize, seed: u64, sample: impl Fn(&mut Random) -> Vec<f32>) -> Vec<Vec<u32>> {
    let mut random = Random::new(seed);
    (0..count).map(|_| bits(&sample(&mut random))).collect()
}

//! Random samples, and the rounding error that GPUs are allowed.

use darboux_dice::Dice;

use crate::vector::{D3, cross, doubles, length, singles, unit};

/// One ulp of 1, the unit of all bounds. WGSL and Vulkan allow errors of 1 ulp for sums and products, 2.5 for
/// quotients and 4.5 for square roots. Fused multiplications and additions have smaller errors.
pub const ULP: f64 = f32::EPSILON as f64;

/// A deterministic sequence of random numbers.
pub struct Random(Dice<'static>);

impl Random {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(Dice::from_seed(seed))
    }

    /// A random word.
    pub fn word(&mut self) -> u32 {
        self.0.word()
    }

    /// A number in [-1, 1).
    pub fn number(&mut self) -> f32 {
        self.word() as i32 as f32 / 2f32.powi(31)
    }

    /// A number in [0, 1).
    pub fn fraction(&mut self) -> f32 {
        0.5 + 0.5 * self.number()
    }

    /// A random unit vector.
    pub fn direction(&mut self) -> [f32; 3] {
        loop {
            let v = [self.number(), self.number(), self.number()];
            if (0.01..=1.0).contains(&length(doubles(v))) {
                return singles(unit(doubles(v)));
            }
        }
    }

    /// A unit normal, and a unit tangent perpendicular to it with a sign.
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

/// The bits of floats.
pub fn bits(floats: &[f32]) -> Vec<u32> {
    floats.iter().map(|float| float.to_bits()).collect()
}

/// `N` floats of a sample, starting at word `start`.
pub fn floats<const N: usize>(sample: &[u32], start: usize) -> [f32; N] {
    std::array::from_fn(|k| f32::from_bits(sample[start + k]))
}

/// Three vectors of a sample, starting at word `start`.
pub fn columns(sample: &[u32], start: usize) -> [D3; 3] {
    [0, 3, 6].map(|k| doubles(floats(sample, start + k)))
}

/// The first `N` words of a sample as integers.
pub fn integers<const N: usize>(sample: &[u32]) -> [i32; N] {
    std::array::from_fn(|k| sample[k] as i32)
}

/// `count` random samples of floats.
pub fn many(count: usize, seed: u64, sample: impl Fn(&mut Random) -> Vec<f32>) -> Vec<Vec<u32>> {
    let mut random = Random::new(seed);
    (0..count).map(|_| bits(&sample(&mut random))).collect()
}

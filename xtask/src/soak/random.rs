//! Random choices that depend on the seed and the number of the case alone.

use fastrand::Rng;

/// The random numbers of one case.
pub struct Random(Rng);

impl Random {
    /// The numbers of case `number` of a run with this seed.
    pub fn new(seed: u64, number: u64) -> Self {
        let mixed = Rng::with_seed(seed).u64(..) ^ number.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        Self(Rng::with_seed(mixed))
    }

    /// A number below `end`; 0 if `end` is 0.
    pub fn below(&mut self, end: usize) -> usize {
        self.0.usize(..end.max(1))
    }

    /// True once in `count` times.
    pub fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    /// One of several values.
    pub fn pick<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.below(values.len())]
    }

    /// A number from 0 to 1.
    pub fn fraction(&mut self) -> f32 {
        self.0.f32()
    }

    /// Any byte.
    pub fn byte(&mut self) -> u8 {
        self.0.u8(..)
    }

    /// A size that is mostly small: a power of two up to `2^largest_exponent`, and a little more or less.
    pub fn size(&mut self, largest_exponent: usize) -> usize {
        let power = 1 << self.below(largest_exponent + 1);
        power + self.below(power)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_has_its_own_repeatable_numbers() {
        let numbers = |seed, case| {
            let mut random = Random::new(seed, case);
            [random.below(1 << 40), random.below(1 << 40)]
        };
        assert_eq!(numbers(1, 2), numbers(1, 2));
        assert_ne!(numbers(1, 2), numbers(1, 3));
        assert_ne!(numbers(1, 2), numbers(2, 2));
    }
}

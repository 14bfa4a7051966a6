//! Random choices, from a seed in tests and from the fuzzer's bytes in fuzzing. A package of its own, so that
//! every crate's tests can use it.

/// A source of random choices. The same source always makes the same choices.
#[derive(Clone, Debug)]
pub struct Dice<'a>(Source<'a>);

#[derive(Clone, Debug)]
enum Source<'a> {
    Seed(u64),
    Bytes(std::slice::Iter<'a, u8>),
}

impl<'a> Dice<'a> {
    /// Choices from a seed (the splitmix64 sequence).
    pub fn from_seed(seed: u64) -> Self {
        Self(Source::Seed(seed))
    }

    /// Choices from bytes, followed by zeros.
    pub fn from_bytes(bytes: &'a [u8]) -> Self {
        Self(Source::Bytes(bytes.iter()))
    }

    fn bits(&mut self, bytes: usize) -> u64 {
        match &mut self.0 {
            Source::Seed(state) => {
                *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
                let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
                let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
                (z ^ (z >> 31)) >> (64 - 8 * bytes)
            }
            Source::Bytes(rest) => {
                rest.by_ref().take(bytes).fold(0, |bits, &byte| bits << 8 | u64::from(byte))
            }
        }
    }

    /// A number below `limit`, which is at least 1 and at most 65,536.
    pub fn below(&mut self, limit: usize) -> usize {
        let bytes = if limit <= 256 { 1 } else { 2 };
        self.bits(bytes) as usize % limit
    }

    /// True once in `n` times.
    pub fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == n - 1
    }

    /// One of `choices`.
    pub fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// Any 32 bits.
    pub fn word(&mut self) -> u32 {
        self.bits(4) as u32
    }

    /// A number in [-1, 1), a multiple of 2^-23.
    pub fn uniform(&mut self) -> f32 {
        self.bits(3) as f32 / (1 << 23) as f32 - 1.0
    }

    /// A number in [-1, 1), a multiple of 2^-52.
    pub fn uniform_f64(&mut self) -> f64 {
        (self.bits(8) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Any 32 bits as a float.
    pub fn any_float(&mut self) -> f32 {
        f32::from_bits(self.word())
    }
}

//! Random bits for the keys of hash functions and fingerprints, so that nobody can make a mesh whose vertices
//! collide.
//!
//! The standard library has random bits wherever the operating system does. WebAssembly in browsers and
//! Node.js has no operating system, and the standard library's keys depend only on the module and its calls
//! there. So the host seeds a generator.

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
mod source {
    use std::hash::{BuildHasher, RandomState};

    #[inline(never)]
    pub fn random_bits() -> u64 {
        RandomState::new().hash_one(0)
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
mod source {
    use std::sync::atomic::{AtomicU64, Ordering};

    /// Without a seed: digits of pi, so that hash functions still mix.
    static STATE: AtomicU64 = AtomicU64::new(0x243f_6a88_85a3_08d3);

    /// Seeds the hash keys of this instance of a WebAssembly module. The host calls it once, before any other
    /// function, with random bits.
    pub fn seed_random(seed: u64) {
        STATE.store(seed, Ordering::Relaxed);
    }

    /// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
    #[inline(never)]
    pub fn random_bits() -> u64 {
        let state = STATE.fetch_add(0x9e37_79b9_7f4a_7c15, Ordering::Relaxed);
        let mixed = (state ^ state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }
}

pub(crate) use source::random_bits;
#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub use source::seed_random;

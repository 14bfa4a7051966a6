//! The widest vector instructions that the machine has, chosen when the program runs.
//!
//! Every task is compiled once per width from one source; lanes round alike in all of them, so that the width never shows in a
//! result. No fused multiply-add: the compiler never fuses on its own.

/// Work that is compiled once per width. `run` must be `#[inline(always)]`.
pub(crate) trait Task {
    fn run(self);
}

/// How wide vector instructions may be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum WidthLimit {
    /// What the program was compiled for: 128 bits on x86-64, Arm and WASM.
    Compiled,
    /// 256 bits: AVX2.
    Bits256,
    /// 512 bits: AVX-512.
    #[default]
    Bits512,
}

/// A vector width that the machine has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Width(#[cfg(target_arch = "x86_64")] WidthLimit);

impl Width {
    /// The widest that the machine has within `limit`.
    #[cfg(target_arch = "x86_64")]
    pub fn widest(limit: WidthLimit) -> Self {
        let has_512 = std::is_x86_feature_detected!("avx512f")
            && std::is_x86_feature_detected!("avx512bw")
            && std::is_x86_feature_detected!("avx512dq")
            && std::is_x86_feature_detected!("avx512vl");
        let has_256 = std::is_x86_feature_detected!("avx2");
        let widest = match (has_512, has_256) {
            (true, _) => WidthLimit::Bits512,
            (_, true) => WidthLimit::Bits256,
            _ => WidthLimit::Compiled,
        };
        Self(widest.min(limit))
    }

    /// The width that the program was compiled for.
    #[cfg(not(target_arch = "x86_64"))]
    pub fn widest(_limit: WidthLimit) -> Self {
        Self()
    }

    /// Runs a task at this width.
    #[cfg(target_arch = "x86_64")]
    #[expect(unsafe_code, reason = "instructions that are found at run time are called so")]
    pub fn run(self, task: impl Task) {
        match self.0 {
            // SAFETY: a width is only made by `widest`, which has found these instructions, or wider ones that include them.
            WidthLimit::Bits512 => unsafe { avx512(task) },
            // SAFETY: as above.
            WidthLimit::Bits256 => unsafe { avx2(task) },
            WidthLimit::Compiled => task.run(),
        }
    }

    /// Runs a task, as a function of its own: where all else is compiled for size, these are not.
    #[cfg(not(target_arch = "x86_64"))]
    #[inline(never)]
    pub fn run(self, task: impl Task) {
        task.run();
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
fn avx512(task: impl Task) {
    task.run();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2(task: impl Task) {
    task.run();
}

//! Vector instructions of the widest kind that the processor has, chosen at run time.
//!
//! Every task is compiled once per vector width, from one source. A lane rounds every operation alike at all
//! widths, and the compiler does not fuse multiplications with additions, so results do not depend on the
//! width.

/// Work that is compiled once per vector width. `run` must be `#[inline(always)]`.
pub(crate) trait Task {
    fn run(self);
}

/// An upper limit of the vector width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum WidthLimit {
    /// The width that the program was compiled for: 128 bits on x86-64, Arm and WebAssembly.
    Compiled,
    /// 256 bits: AVX2.
    Bits256,
    /// 512 bits: AVX-512.
    #[default]
    Bits512,
}

/// A vector width that the processor has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Width(#[cfg(target_arch = "x86_64")] WidthLimit);

impl Width {
    /// The largest width within `limit` that the processor has.
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
    #[expect(unsafe_code, reason = "functions with target features are unsafe to call")]
    pub fn run(self, task: impl Task) {
        match self.0 {
            // SAFETY: only `widest` makes a width, and it has detected these instructions or wider ones that
            // include them.
            WidthLimit::Bits512 => unsafe { avx512(task) },
            // SAFETY: as above.
            WidthLimit::Bits256 => unsafe { avx2(task) },
            WidthLimit::Compiled => task.run(),
        }
    }

    /// Runs a task as a separate function, so that builds for size can compile it for speed.
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

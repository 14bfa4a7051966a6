//! How work runs: SIMD widths, threads, and the windows of the triangle list that threads divide among them.

pub(crate) mod limits;
pub(crate) mod simd;
pub(crate) mod threads;
pub(crate) mod windows;

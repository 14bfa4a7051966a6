//! How work is executed: vector widths, threads, the limits of a call, and windows of the triangle list.

pub(crate) mod blocks;
#[cfg(feature = "parallel")]
mod helpers;
pub(crate) mod limits;
pub(crate) mod simd;
pub(crate) mod threads;
pub(crate) mod vertex_progress;
pub(crate) mod windows;

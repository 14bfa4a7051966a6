//! The GPU of `tangents --device gpu` and `devices`, and its stand-in for builds without GPU support.

pub mod adapter;

#[cfg(not(feature = "gpu"))]
mod absent;
#[cfg(feature = "gpu")]
mod present;

#[cfg(not(feature = "gpu"))]
pub use absent::{NO_ADAPTERS, OpenGpu, adapters, open};
#[cfg(feature = "gpu")]
pub use present::{NO_ADAPTERS, OpenGpu, adapters, open};

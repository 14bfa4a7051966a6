//! The GPU of `tangents --device gpu` and `devices`, and its stand-in for builds without the feature `gpu`.

#[cfg(not(feature = "gpu"))]
mod absent;
#[cfg(feature = "gpu")]
pub mod adapter;
#[cfg(feature = "gpu")]
mod driver_messages;
#[cfg(feature = "gpu")]
mod present;

#[cfg(not(feature = "gpu"))]
pub use absent::{OpenGpu, open, open_early};
#[cfg(feature = "gpu")]
pub use driver_messages::without_driver_messages;
#[cfg(feature = "gpu")]
pub use present::{OpenGpu, adapters, open, open_early};

//! The subcommands: each has its arguments in `arguments.rs` and its entry point beside it.

#[cfg(feature = "bake")]
pub mod bake;
pub mod check;
pub mod compare;
pub mod completions;
pub mod convert;
#[cfg(feature = "gpu")]
pub mod devices;
pub mod inspect;
pub mod methods;
#[cfg(not(all(feature = "bake", feature = "gpu", feature = "view")))]
pub mod missing;
pub mod normals;
#[cfg(feature = "gpu")]
pub mod render;
pub mod report;
pub mod tangents;
#[cfg(feature = "view")]
pub mod view;

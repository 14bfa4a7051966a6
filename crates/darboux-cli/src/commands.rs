//! The subcommands: each has its arguments in `arguments.rs` and its entry point beside it.

pub mod compare;
pub mod convert;
pub mod devices;
pub mod inspect;
pub mod methods;
pub mod normals;
#[cfg(feature = "gpu")]
pub mod render;
pub mod tangents;
pub mod view;

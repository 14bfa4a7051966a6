//! Arguments that several subcommands share.

pub mod angle;
pub mod choice;
pub mod convention;
pub mod files;
pub mod formats;
#[cfg(feature = "bake")]
pub mod given;
pub mod messages;
pub mod reading;
pub mod shading;

//! Arguments that several subcommands share.

pub mod angle;
pub mod convention;
pub mod files;
pub mod messages;
pub mod method;
pub mod reading;
pub mod shading;

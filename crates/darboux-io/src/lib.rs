//! Files to arrays and back: glTF and GLB, changed only where tangents require it; normal maps in PNG.
//!
//! [`gltf::Document`] reads a file, gives the values behind its accessors, takes edits, and writes everything else back as
//! it was.

mod error;
pub mod gltf;
pub mod image;
mod memory_limit;
pub mod obj;
mod paths;
mod staging;

pub use error::Error;
pub use memory_limit::MemoryLimit;
pub use paths::{FileKind, readable};
pub use staging::{RunId, SaveOptions};

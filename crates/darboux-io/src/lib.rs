//! Files to arrays and back: glTF and GLB, changed only where tangents require it.
//!
//! [`gltf::Document`] reads a file, gives the values behind its accessors, takes edits, and writes everything else back as
//! it was.

mod error;
pub mod gltf;

pub use error::Error;

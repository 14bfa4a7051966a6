//! Wavefront OBJ: reads a model with its material libraries and textures as a glTF document.
//!
//! [`companions`] lists the files that an OBJ refers to; `read` (feature `obj`) reads the model itself.

mod companions;
#[cfg(feature = "obj")]
mod corner_tree;
#[cfg(feature = "obj")]
mod document;
#[cfg(feature = "obj")]
mod faces;
#[cfg(feature = "obj")]
mod libraries;
#[cfg(feature = "obj")]
mod read;

pub use companions::{Companion, companions};
#[cfg(feature = "obj")]
pub use read::{ObjModel, read};

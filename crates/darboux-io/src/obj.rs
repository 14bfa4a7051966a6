//! Wavefront OBJ with its material libraries (MTL) and textures.
//!
//! [`companions`] lists the files that an OBJ refers to. The reader (feature `obj`) gives objects and groups
//! as meshes, with faces of any size and smoothing groups.

mod companions;
mod lookup;
#[cfg(feature = "obj")]
mod materials;
#[cfg(feature = "obj")]
mod meshes;
#[cfg(feature = "obj")]
mod mtl;
#[cfg(feature = "obj")]
mod read;
mod statements;
#[cfg(feature = "obj")]
mod text;
#[cfg_attr(
    not(feature = "obj"),
    allow(dead_code, reason = "the lookup of companions needs the name of the file alone")
)]
mod texture_map;

pub use companions::{Companion, companions};
#[cfg(feature = "obj")]
pub(crate) use read::read;

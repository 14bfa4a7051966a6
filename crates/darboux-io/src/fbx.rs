//! Autodesk FBX, binary and ASCII, versions 6100 to 7700.
//!
//! ```text
//! load        ufbx parses the file, within the memory limit
//! scene       nodes with their paths, and the meshes that they use
//! geometry    faces of any size, with the values of their corners
//! deformers   skins and blend shapes
//! materials   shading, textures, normal maps
//! placement   how textures are moved, turned and scaled
//! ```
//!
//! ufbx is C code. Programs that read files of strangers and want no C code leave the feature `fbx` out.

mod deformers;
mod geometry;
mod load;
mod materials;
mod placement;
mod scene;

use crate::LoadOptions;
use crate::error::ContentError;
use crate::source::{ModelFiles, SourceScene};

/// Reads an FBX. Errors: bytes that are no FBX, or a truncated or broken one; a scene that needs more memory
/// than the limit.
pub(crate) fn read(
    bytes: &[u8],
    files: &ModelFiles,
    options: &LoadOptions,
) -> Result<SourceScene, ContentError> {
    let budget = options.budget(bytes.len(), 0);
    let scene = load::load(bytes, &budget)?;
    let mut made = scene::scene(&scene, files, &budget)?;
    made.warnings.splice(0..0, load::warnings(&scene));
    Ok(made)
}

//! Bakes the detail of high-poly models into normal, height, occlusion and position maps of low-poly models.
//!
//! A normal map is right only together with the tangent frames of the mesh that it was baked for. [`bake()`] puts the normals of the high
//! surfaces into the frames that a renderer will use: MikkTSpace's, interpolated and not normalised, with the bitangent per pixel or per
//! vertex.
//!
//! ```text
//! layout     1  which low triangles each block of the image needs
//! coverage   2  which low triangle covers each sample
//! face, rays 3  the point on it, and the ray through the point
//! bvh, high  4  the first hit on the high surfaces, and the normal there
//! frame      5  that normal in the frame of the low surface, as a renderer will undo it
//! texel      6  the samples of a texel become its content
//! padding    7  texels without a hit are filled from the nearest one
//! ```

mod bake;
mod band;
mod budget;
mod bvh;
mod common_box;
mod coverage;
mod error;
mod face;
mod frame;
mod gutter;
mod gutter_samples;
mod high;
mod images;
mod layout;
mod limits;
mod memory;
mod model;
mod name_match;
mod normal_texture;
mod occlusion;
mod options;
mod padding;
mod point;
mod rays;
mod report;
mod samples;
mod space;
mod surface;
mod texel;
mod text;
mod vector;
mod verify;

pub use bake::{BakeProgress, Baked, bake};
pub use error::BakeError;
pub use images::{Images, TexelState};
pub use model::{HighModel, HighModelOptions, LowModel, LowModelOptions, UnpairedParts, group_by_name};
pub use name_match::{NameMatch, match_names};
pub use normal_texture::NormalTexture;
pub use options::{BakeOptions, Bitangent, MapKind, MapSet};
pub use report::BakeReport;
pub use space::{ConvertedSpace, NormalSpace, SpaceOptions, convert_space};
pub use surface::{HighSurface, LowSurface, default_cage_offset, inflated_cage};
pub use verify::{ErrorStatistics, Mistake, Verification, VerifiedPlace, check_verification, verify};

/// The example of README.md compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

//! Bakes the detail of high-poly models into maps of low-poly models: normals, heights, occlusion, thickness,
//! curvature, materials and more.
//!
//! A normal map is right only together with the tangent frames of the mesh that it was baked for. [`bake()`]
//! puts the normals of the high surfaces into the frames that a renderer will use: MikkTSpace's, interpolated
//! and not normalised, with the bitangent per pixel or per vertex.
//!
//! ```text
//! layout     1  which low triangles each block of the image needs
//! coverage   2  which low triangle covers each sample
//! face, rays 3  the point on it, and the ray through the point
//! bvh, high  4  the first hit on the high surfaces, and the normal there
//! frame      5  that normal in the frame of the low surface, as a renderer will undo it
//! maps       6  what each map has there; the samples of a texel become its content
//! padding    7  texels without a hit are filled from the nearest one
//! ```

mod auto_cage;
mod bake;
mod band;
mod budget;
mod bvh;
mod cage;
mod charts;
mod color_texture;
mod common_box;
mod coverage;
mod covered_tiles;
mod crossing;
mod error;
mod face;
mod found;
mod frame;
mod gutter;
mod gutter_samples;
mod high;
mod images;
mod layout;
mod limits;
mod map_kind;
mod maps;
mod material;
mod memory;
mod model;
mod name_match;
mod normal_texture;
mod options;
mod padding;
mod palette;
mod point;
mod prepared;
mod ray_origin;
mod rays;
mod report;
mod samples;
mod skew;
mod space;
mod surface;
mod texel;
mod text;
mod texture_wrap;
mod udim;
mod vector;
mod verify;

pub use auto_cage::{AutoCage, AutoCageOptions, auto_cage};
pub use bake::{BakeProgress, Baked, bake};
pub use cage::{
    default_cage_offset, default_cage_reach, inflated_cage, inflated_cage_by, with_cages, with_skew,
};
pub use color_texture::ColorTexture;
pub use covered_tiles::udims_of;
pub use crossing::crossing_triangles;
pub use error::BakeError;
pub use images::{Images, TexelState};
pub use map_kind::{MapContent, MapKind, MapSet};
pub use material::{AlphaMode, MaterialProperty};
pub use model::{
    HighModel, HighModelOptions, LowModel, LowModelOptions, ModelSurfaces, Models, ModelsError, PartMatch,
    UnpairedParts, cage_of, group_by_name, is_color_texture,
};
pub use name_match::{HIGH_SUFFIXES, LOW_SUFFIXES, NameMatch, match_names, suffix_start};
pub use normal_texture::NormalTexture;
pub use options::{BakeOptions, Bitangent, CurvatureRadius, IdSource, OcclusionFalloff, OcclusionWeights};
pub use palette::IdColor;
pub use prepared::PreparedSurfaces;
pub use ray_origin::{Cages, RayOrigin};
pub use report::BakeReport;
pub use skew::SkewCorrection;
pub use space::{ConvertedSpace, NormalSpace, SpaceOptions, convert_space};
pub use surface::{HighSurface, LowSurface, SurfaceLabels};
pub use udim::Udim;
pub use verify::{ErrorStatistics, Mistake, Verification, VerifiedPlace, check_verification, verify};

/// The example of README.md compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

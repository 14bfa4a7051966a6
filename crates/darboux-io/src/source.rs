//! Models of other formats: what their readers return, and the glTF document that it becomes.
//!
//! ```text
//! format      which format a file has, by its content
//! others      what a file is that no reader takes
//! scene       what a reader returns: nodes, meshes of polygons, materials, skins, as the file has them
//! files       the textures and libraries that a model refers to, under the rules of glTF
//! other_case  finds those whose names differ in the case of letters or the encoding only
//! smoothing   normals by smoothing groups, where a file has none
//! polygons/   faces of more than three corners are cut
//! vertices    corners with the same attributes become one vertex
//! build/      the glTF, and its provenance
//! provenance  where the parts of a document came from, and which triangles were quads
//! ```
//!
//! Every reader is a function from bytes to a `SourceScene`; `readers.rs` chooses among them.

mod build;
mod files;
mod format;
mod other_case;
mod others;
mod polygons;
#[cfg(any(feature = "obj", feature = "ply", feature = "stl"))]
mod program;
mod provenance;
pub(crate) mod scene;
mod smoothing;
mod vertices;

pub use format::SourceFormat;
pub use polygons::PolygonRule;
pub use provenance::{FaceCounts, PrimitiveSource, Provenance, UnreadMap};

pub(crate) use build::{Built, build};
pub(crate) use files::{FileSource, FoundFile, LONGEST_PATH, ModelFiles};
pub(crate) use format::{detect, without_byte_order_mark};
pub(crate) use others::problem as problem_of_other;
#[cfg(any(feature = "obj", feature = "ply", feature = "stl"))]
pub(crate) use program::program_of_comment;
pub(crate) use scene::{
    CornerValues, FaceSizes, SourceImage, SourceMaterial, SourceMesh, SourceScene, SourceTexture, SourceUvSet,
};
#[cfg(any(feature = "fbx", feature = "obj"))]
pub(crate) use scene::{MissingImage, MissingNormalMap, NormalMap};
#[cfg(feature = "fbx")]
pub(crate) use scene::{SourceMorph, SourceNode, SourceSkin, VertexWeights};
#[cfg(feature = "fbx")]
pub(crate) use smoothing::MadeNormals;

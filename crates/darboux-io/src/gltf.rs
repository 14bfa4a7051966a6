//! glTF 2.0 and GLB: a document that is read, edited in place and written back with everything else untouched.

mod accessor;
mod append;
mod compare;
mod compression;
pub(crate) mod container;
mod convert;
mod corners;
mod document;
mod file_bytes;
mod inspect;
mod json;
mod layout;
mod looks;
mod normals;
mod object;
pub(crate) mod pieces;
mod references;
mod resources;
mod save;
mod scene;
pub mod schema;
mod tangents;
mod values;
mod waste;

pub use accessor::{Elements, NewAccessor, Target};
pub use compare::{Pair, PairedCorners, Unpaired, pair_tangents};
pub use convert::{ConversionSummary, convert_vertices};
pub use corners::PrimitiveCorners;
pub use document::{Document, LoadOptions};
pub use inspect::{PrimitiveInfo, inspect};
pub use looks::{Alpha, Look, TextureUse, Wrap};
pub use normals::{
    NormalsOptions, NormalsOutcome, NormalsSummary, PrimitiveNormals, WrittenNormals, add_normals,
};
pub use scene::{PlacedMesh, PlacedMeshes};
pub use schema::{ComponentType, ElementType};
pub use tangents::{
    Counts, Generate, Outcome, PrimitiveName, PrimitiveSummary, Progress, Summary, TangentEncoding,
    TangentsOptions, Totals, Written, add_tangents, add_tangents_with,
};
pub use values::IndexList;

//! glTF 2.0 and GLB: documents that are read, edited, and written with everything else preserved.
//!
//! ```text
//! load, container, buffers, resources                  reading: the file, its buffers; its JSON is read in `crate::json`
//! document, schema, references                         the one truth: a JSON value and buffers; typed parts; checks of references
//! compression/                                         compressed data becomes plain data
//! accessors, stored_elements, elements                 accessors as arrays, and arrays as accessors
//! tangents/, normals/, convert/                        operations on documents; primitives/ is what they share
//! edit/                                                edits, which all operations write through
//! inspect, compare, scene, materials, image_*          descriptions of documents
//! unused_data, output, save                            writing: what is left out, where the rest goes, files
//! exchange/                                            writing PLY and OBJ
//! ```

mod accessors;
mod buffers;
mod compare;
mod compression;
pub(crate) mod container;
mod convert;
mod document;
mod edit;
mod element_type;
mod elements;
mod exchange;
mod file_bytes;
mod image_source;
mod image_uses;
mod inspect;
mod load;
mod materials;
mod normals;
mod objects_only;
mod output;
mod portable_names;
mod primitives;
mod progress;
mod references;
mod resources;
mod save;
mod scene;
pub mod schema;
pub(crate) mod segments;
mod stored_elements;
mod tangents;
mod unused_data;

pub use compare::{Pair, PairedCorners, Unpaired, pair_tangents};
pub use convert::{ConversionSummary, convert_vertices};
pub use document::Document;
pub use edit::Checkpoint;
pub use edit::materials::MaterialTexture;
pub use element_type::{ComponentType, ElementType};
pub use elements::{Elements, NewAccessor, Target};
pub use image_source::ImageSource;
pub use inspect::{PrimitiveInfo, inspect};
pub use materials::{Alpha, Material, TextureUse, Wrap};
pub use normals::{
    AddNormalsOptions, NormalsOutcome, NormalsSummary, PrimitiveNormals, WrittenNormals, add_normals,
    add_normals_to, add_normals_with,
};
pub use primitives::corners::PrimitiveCorners;
pub use primitives::name::PrimitiveName;
pub use progress::Progress;
pub use resources::file_of_uri;
pub use scene::{MeshInstance, MeshInstances};
pub use stored_elements::IndexList;
pub use tangents::{
    AddTangentsOptions, Generate, GenerateFn, GivenTangents, PrimitiveTangents, ReportCounts,
    TangentEncoding, TangentsOutcome, TangentsSummary, TangentsTotals, WrittenTangents, add_tangents,
    add_tangents_to, add_tangents_with,
};

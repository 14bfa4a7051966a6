//! glTF 2.0 and GLB: documents that are read, edited, and written with everything else preserved.
//!
//! ```text
//! load, parse, container, buffers, resources, references   reading: the file, the JSON, the buffers, checks
//! document, edits, edit_document, edit_image,
//! edit_material, checkpoint, schema                                   a document, its edits, and the parts of its JSON
//! accessors, stored_elements, elements                 accessors as arrays, and arrays as accessors
//! tangents/, normals/, convert/, compression/          operations on documents; primitives/ is what they share
//! inspect, compare, scene, materials, image_uses       descriptions of documents
//! json_text, output_layout, unused_data, save          writing: edited text, offsets, removal of unused data, files
//! ```

mod accessors;
mod buffers;
mod checkpoint;
mod compare;
mod compression;
pub(crate) mod container;
mod convert;
mod document;
mod edit_document;
mod edit_image;
mod edit_material;
mod edits;
mod element_type;
mod elements;
mod file_bytes;
mod image_uses;
mod inspect;
mod json_text;
mod load;
mod materials;
mod normals;
mod objects_only;
mod output_layout;
mod parse;
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

pub use checkpoint::Checkpoint;
pub use compare::{Pair, PairedCorners, Unpaired, pair_tangents};
pub use convert::{ConversionSummary, convert_vertices};
pub use document::Document;
pub use element_type::{ComponentType, ElementType};
pub use elements::{Elements, NewAccessor, Target};
pub use inspect::{PrimitiveInfo, inspect};
pub use materials::{Alpha, Appearance, TextureUse, Wrap};
pub use normals::{
    AddNormalsOptions, NormalsOutcome, NormalsSummary, PrimitiveNormals, WrittenNormals, add_normals,
    add_normals_to, add_normals_with,
};
pub use primitives::corners::PrimitiveCorners;
pub use primitives::name::PrimitiveName;
pub use progress::Progress;
pub use scene::{PlacedMesh, PlacedMeshes};
pub use stored_elements::IndexList;
pub use tangents::{
    AddTangentsOptions, Generate, GenerateFn, PrimitiveTangents, ReportCounts, TangentEncoding,
    TangentsOutcome, TangentsSummary, TangentsTotals, WrittenTangents, add_tangents, add_tangents_to,
    add_tangents_with,
};

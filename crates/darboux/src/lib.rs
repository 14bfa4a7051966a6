//! Tangent frames for normal mapping: MikkTSpace bit for bit, and the vertex splitting that its seams demand.
//!
//! Borrow a mesh, get one tangent per *corner* (a vertex of one face), then [`split_vertices`] to go back to
//! an indexed mesh. Corner tangents cannot be written through the old index list by accident: they have a
//! type of their own.
//!
//! ```
//! use darboux::{Mesh, TangentOptions, generate_tangents, split_vertices};
//!
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
//! let normals = [[0.0, 0.0, 1.0]; 4];
//! let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
//! let indices = [0u16, 1, 2, 0, 2, 3];
//!
//! let mesh = Mesh::triangles(&positions, &normals, &uvs, &indices)?;
//! let tangents = generate_tangents(&mesh, &TangentOptions::default());
//! let split = split_vertices(&mesh, &tangents.corners)?;
//! assert_eq!(split.tangent_of_vertex, [[1.0, 0.0, 0.0, 1.0]; 4]);
//! assert_eq!(split.indices, [0, 1, 2, 0, 2, 3]);
//! # Ok::<(), darboux::Error>(())
//! ```
//!
//! A function whose time grows with the mesh has a short form, such as [`generate_tangents`], and a form that
//! takes a [`Context`], such as [`generate_tangents_with`]: the context carries reused memory, a cancellation
//! token and a thread limit. Functions named `write_*` fill
//! the caller's array. Parameters come in one order: positions, normals, UVs, indices (or a mesh of these),
//! options, context, output. The context is always `&mut Context`, also where a function does not reuse
//! memory today, so that it can do so in a later version.
//!
//! Options, option enums, reports and errors are `#[non_exhaustive]`: they gain fields and variants in minor
//! versions. Options are made by `new`, `default` or `From` and changed by `with_*` methods. Plain data is
//! exhaustive, so that it can be written and taken apart: [`Frame`], [`Transform`], [`Convention`],
//! [`Faces`], [`Indices`] and the results of functions.

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "where NaN must take a branch, the negated comparison is the statement"
)]

mod cancel;
mod choice;
mod context;
mod convention;
pub mod encode;
mod error;
mod exec;
mod frame;
#[doc(hidden)]
pub mod internal;
mod math;
mod math_f64;
mod measure;
mod mesh;
mod normal_map;
mod normals;
mod plan;
mod recipe;
mod split;
mod tangents;
mod topology;
mod transform;
mod util;

pub use cancel::Cancel;
pub use choice::{Choice, UnknownName};
pub use context::Context;
pub use convention::{
    Axes, Axis, BitangentDirection, Convention, ConventionError, Conversion, Handedness, SignRule,
    TangentDirection, UvOrigin, Winding,
};
pub use error::Error;
pub use frame::{CornerFrames, CornerNormals, CornerNormalsRef, CornerTangents, CornerTangentsRef, Frame};
pub use measure::{
    CornerDifference, TangentDifference, UvFidelity, measure_tangents, measure_tangents_with,
    measure_uv_fidelity, measure_uv_fidelity_with,
};
pub use mesh::{Faces, Indices, Mesh, Strided};
pub use normal_map::{
    Channel, MapJudgement, MapTiles, MapVerdict, NormalMapJudge, SrgbMistake, TexelLayout, judge_normal_map,
    repack_texels,
};
pub use normals::{
    NormalOptions, NormalPlan, NormalReport, NormalSplit, NormalWeight, Normals, Shading, SmoothingSeams,
    generate_normals, generate_normals_with, split_normals, split_normals_with,
};
pub use plan::Plan;
pub use recipe::{
    Recipe, RecipeMatch, RecipeRounding, RecipeWriting, recognise_recipe, recognise_recipe_with,
};
pub use split::{SplitBuffer, Splitter, VertexSplit, split_vertices, split_vertices_with};
pub use tangents::{
    CompactFrames, Frames, Method, MikkTSpaceOptions, Mode, Report, TangentOptions, Tangents,
    generate_compact_frames, generate_frames, generate_frames_with, generate_tangents,
    generate_tangents_with, write_frames, write_tangents,
};
pub use transform::Transform;

//! Tangents into a document: chosen, shared, computed, split, morphed and written, with everything else left as it is.

mod summary;

pub use summary::{Counts, Outcome, PrimitiveName, PrimitiveSummary, Summary, Totals, Written};

use darboux::TangentOptions;

use super::Document;
use crate::Error;

/// What [`add_tangents`] does. The default is right for today's renderers: every triangle primitive that has no tangents yet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TangentsOptions {
    /// How tangents are computed.
    pub tangents: TangentOptions,
    /// Replace tangents that exist.
    pub overwrite: bool,
    /// Only primitives whose material uses tangents.
    pub only_needed: bool,
    /// Refuse documents with non-finite vertex data or corners that have no usable tangent.
    pub strict: bool,
    /// Transform the UVs by `KHR_texture_transform` first. The specification takes them as stored.
    pub apply_texture_transform: bool,
}

/// How far [`add_tangents`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Triangles computed.
    pub done: usize,
    /// Triangles to compute.
    pub total: usize,
}

/// Gives every triangle primitive that has positions, normals and UVs its tangents.
///
/// Nothing to do is success: the document stays unchanged. Errors: broken data behind a primitive that gets tangents; with
/// [`TangentsOptions::strict`], unusable vertex data. After an error the document may be half done: drop it.
pub fn add_tangents(
    document: &mut Document,
    options: &TangentsOptions,
    progress: &mut dyn FnMut(Progress),
) -> Result<Summary, Error> {
    let _ = (document, options, progress);
    todo!()
}

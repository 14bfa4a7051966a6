//! What a document holds, per primitive, without changing it.

use serde::Serialize;

use super::Document;
use super::tangents::{Counts, PrimitiveName};
use crate::Error;

/// What [`inspect`] finds out about a primitive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PrimitiveInfo {
    /// Which one.
    #[serde(flatten)]
    pub name: PrimitiveName,
    /// `TRIANGLES`, `TRIANGLE_STRIP`, `POINTS` and so on.
    pub mode: &'static str,
    /// The length of its vertex attributes.
    pub vertices: usize,
    /// Its attributes, as the file names them.
    pub attributes: Vec<String>,
    /// The number of morph targets.
    pub morph_targets: usize,
    /// The UV set that its tangents follow: n of `TEXCOORD_n`.
    pub uv_set: usize,
    /// Why this one: the texture that names it, or that none does.
    pub uv_reason: String,
    /// Whether it has tangents.
    pub has_tangents: bool,
    /// Whether its material uses tangents.
    pub needs_tangents: bool,
    /// Why tangents cannot be computed, as a sentence; none where they can.
    pub ineligible: Option<String>,
    /// Triangles whose texture is mirrored.
    pub mirrored_triangles: usize,
    /// Its triangles, and what computing their tangents meets.
    #[serde(flatten)]
    pub counts: Counts,
}

/// Looks at every primitive of the document, computing the tangents that it could have without writing them.
///
/// Errors: broken data behind a primitive that can have tangents.
pub fn inspect(document: &mut Document) -> Result<Vec<PrimitiveInfo>, Error> {
    let _ = document;
    todo!()
}

//! Options of [`add_tangents`](super::add_tangents).

use darboux::TangentOptions;

use super::encoding::TangentEncoding;

/// What [`add_tangents`](super::add_tangents) does. The default is right for today's renderers: every triangle primitive that has no tangents yet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TangentsOptions {
    /// How tangents are computed.
    pub tangents: TangentOptions,
    /// How tangents are stored.
    pub encoding: TangentEncoding,
    /// Replace tangents that exist.
    pub overwrite: bool,
    /// Only primitives whose material uses tangents.
    pub only_needed: bool,
    /// Refuse documents with non-finite vertex data or corners that have no usable tangent.
    pub strict: bool,
    /// Transform the UVs by `KHR_texture_transform` first. The specification takes them as stored.
    pub apply_texture_transform: bool,
}

//! Options of [`add_tangents`](super::add_tangents).

use darboux::TangentOptions;

use super::encoding::TangentEncoding;

/// Options of [`add_tangents`](super::add_tangents). The default adds MikkTSpace tangents to every triangle primitive without tangents.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TangentsOptions {
    /// How tangents are computed.
    pub tangents: TangentOptions,
    /// How tangents are stored.
    pub encoding: TangentEncoding,
    /// Replaces existing tangents.
    pub overwrite: bool,
    /// Selects only primitives whose material uses tangents.
    pub only_needed: bool,
    /// Refuses vertex data that is not finite, and corners without a usable tangent.
    pub strict: bool,
    /// Applies `KHR_texture_transform` to the UVs first. The specification uses the stored UVs.
    pub apply_texture_transform: bool,
}

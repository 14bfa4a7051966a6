//! Options of [`add_tangents`](super::add_tangents).

use darboux::TangentOptions;

use super::encoding::TangentEncoding;

/// Options of [`add_tangents`](super::add_tangents). The default adds MikkTSpace tangents to every triangle
/// primitive without tangents.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct AddTangentsOptions {
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

impl AddTangentsOptions {
    /// These options with another way to compute tangents.
    #[must_use]
    pub fn with_tangents(self, tangents: TangentOptions) -> Self {
        Self { tangents, ..self }
    }

    /// These options with another encoding.
    #[must_use]
    pub fn with_encoding(self, encoding: TangentEncoding) -> Self {
        Self { encoding, ..self }
    }

    /// These options with existing tangents replaced, or kept.
    #[must_use]
    pub fn with_overwrite(self, overwrite: bool) -> Self {
        Self { overwrite, ..self }
    }

    /// These options for primitives whose material uses tangents, or for all.
    #[must_use]
    pub fn with_only_needed(self, only_needed: bool) -> Self {
        Self { only_needed, ..self }
    }

    /// These options with unusable data refused, or counted.
    #[must_use]
    pub fn with_strict(self, strict: bool) -> Self {
        Self { strict, ..self }
    }

    /// These options with texture transforms applied to the UVs first, or not.
    #[must_use]
    pub fn with_apply_texture_transform(self, apply_texture_transform: bool) -> Self {
        Self { apply_texture_transform, ..self }
    }
}

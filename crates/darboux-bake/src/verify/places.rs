//! What the errors of a verification are sorted by.

use serde::Serialize;

/// What the filter reads at a point, which decides why the point has an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum VerifiedPlace {
    /// Texels with hits of their own: what remains is resolution and rounding.
    Inside,
    /// Also texels outside the chart.
    Border,
    /// Also texels whose rays missed, and that were filled from around.
    Missed,
    /// Texels that another triangle owns, which overlaps this one.
    Overlap,
}

impl VerifiedPlace {
    /// All places.
    pub const ALL: [Self; 4] = [Self::Inside, Self::Border, Self::Missed, Self::Overlap];
}

/// A difference between a renderer and the bake.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Mistake {
    /// The bitangent per vertex, for a map with the bitangent per pixel; or the other way round.
    OtherBitangent,
    /// Green points the other way.
    OtherGreen,
    /// Normal and tangent are normalised per pixel before they are used.
    NormalisedFrame,
}

impl Mistake {
    /// All mistakes.
    pub const ALL: [Self; 3] = [Self::OtherBitangent, Self::OtherGreen, Self::NormalisedFrame];
}

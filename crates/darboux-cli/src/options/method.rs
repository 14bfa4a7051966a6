//! `--method`: the names of the tangent methods.

use clap::ValueEnum;

/// `--method`: the names of [`darboux::Method`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// The standard of bakers and engines
    #[default]
    #[value(name = "mikktspace")]
    MikkTSpace,
    /// Weighted by angle and area: follows the UVs most closely, for surfaces without a baked normal map
    AngleArea,
    /// Weighted by angle and edge lengths, meshoptimizer's default
    AngleEdge,
    /// The sum of dP/du, separate for each UV orientation
    Lengyel,
    /// The sum of dP/du per vertex, as in three.js and many tutorials: wrong at mirrored seams
    LengyelPerVertex,
    /// The mean of the triangles' tangents
    Average,
    /// The mean of the triangles' tangents, weighted by area
    Area,
    /// One tangent per face, not smoothed
    Face,
    /// Any direction perpendicular to the normal, independent of UVs
    FromNormal,
}

impl From<MethodName> for darboux::Method {
    fn from(method: MethodName) -> Self {
        match method {
            MethodName::MikkTSpace => Self::default(),
            MethodName::AngleArea => Self::AngleArea,
            MethodName::AngleEdge => Self::AngleEdge,
            MethodName::Lengyel => Self::Lengyel,
            MethodName::LengyelPerVertex => Self::LengyelPerVertex,
            MethodName::Average => Self::Average,
            MethodName::Area => Self::Area,
            MethodName::Face => Self::Face,
            MethodName::FromNormal => Self::FromNormal,
        }
    }
}

//! `--method`: the names of the tangent methods.

use clap::ValueEnum;

/// `--method`: the names of [`darboux::Method`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// The standard of bakers and engines
    #[default]
    #[value(name = "mikktspace")]
    MikkTSpace,
    /// Weighted by angle and area: follows the UVs best where no baked map asks for MikkTSpace
    AngleArea,
    /// Sums of dP/du, one per UV orientation
    Lengyel,
    /// Sums of dP/du, one per vertex, as three.js and many tutorials: breaks mirrored seams
    LengyelPerVertex,
    /// Mean of the triangles' tangents
    Average,
    /// Mean weighted by area
    Area,
    /// Each face its own: exact, not smooth
    Face,
    /// Any perpendicular of the normal; needs no UVs, and says nothing about them
    FromNormal,
}

impl From<MethodName> for darboux::Method {
    fn from(method: MethodName) -> Self {
        match method {
            MethodName::MikkTSpace => Self::default(),
            MethodName::AngleArea => Self::AngleArea,
            MethodName::Lengyel => Self::Lengyel,
            MethodName::LengyelPerVertex => Self::LengyelPerVertex,
            MethodName::Average => Self::Average,
            MethodName::Area => Self::Area,
            MethodName::Face => Self::Face,
            MethodName::FromNormal => Self::FromNormal,
        }
    }
}

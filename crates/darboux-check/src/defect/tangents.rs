//! [`TangentFault`]: what is wrong with the tangents of a primitive.

use darboux::Recipe;

use crate::code::Code;
use crate::indices::{Indices, Items, Part};
use crate::measure::fit::Difference;
use crate::measure::recipe::{Far, Recognised};

/// What is wrong with tangents.
#[derive(Clone, Debug, PartialEq)]
pub enum TangentFault {
    /// The number of vertices without tangents.
    Missing(usize),
    /// Tangents that nothing reads.
    Unused {
        /// Their size.
        bytes: usize,
        /// What is wrong with them, each code once.
        also: Vec<Code>,
    },
    NotFinite(Part),
    Zero(Part),
    NotUnit(Part),
    Leaning {
        vertices: Indices,
        /// The largest angle to the plane of the normal, in degrees.
        worst: f64,
    },
    SignNotOne(Part),
    SharedAcrossMirror(Part),
    /// Triangles with both signs.
    SignMixed(Part),
    /// Directions or signs differ from MikkTSpace's in a known way.
    Differs(TangentDifference),
    /// Some tangents are far from the method of the other tangents.
    Outliers {
        recipe: Recipe,
        vertices: Part,
    },
    OtherRecipe {
        recognised: Recognised,
        /// Where no known method made them: those that are far from MikkTSpace.
        far: Far,
    },
}

/// A known difference from MikkTSpace's tangents.
#[derive(Clone, Debug, PartialEq)]
pub struct TangentDifference {
    pub difference: Difference,
    /// The number of corners, vertices or triangles that support it, of those that were measured.
    pub supporting: usize,
    pub measured: usize,
    /// These triangles or vertices, where it is about a part of the surface.
    pub items: Indices,
    /// Where most tangents are negated: the vertices whose tangents are not.
    pub exceptions: Indices,
    /// By area, the part of what was measured whose signs are flipped, in percent.
    pub flipped_percent: f64,
    /// The UV set that the tangents should follow.
    pub uv_set: usize,
    /// Whether it follows from reversed normals.
    pub follows_from_normals: bool,
}

impl TangentFault {
    pub fn code(&self) -> Code {
        match self {
            Self::Missing(_) => Code::TangentMissing,
            Self::Unused { .. } => Code::TangentUnused,
            Self::NotFinite(_) => Code::TangentNotFinite,
            Self::Zero(_) => Code::TangentZero,
            Self::NotUnit(_) => Code::TangentNotUnit,
            Self::Leaning { .. } => Code::TangentNotPerpendicular,
            Self::SignNotOne(_) => Code::TangentSignNotOne,
            Self::SharedAcrossMirror(_) => Code::TangentSharedAcrossMirror,
            Self::SignMixed(_) => Code::TangentSignMixed,
            Self::Differs(difference) => difference.code(),
            Self::Outliers { .. } | Self::OtherRecipe { .. } => Code::TangentOtherRecipe,
        }
    }

    /// Whether it is about single tangents, which can be corrected without changing others.
    pub fn is_about_single_tangents(&self) -> bool {
        match self {
            Self::NotFinite(_)
            | Self::Zero(_)
            | Self::NotUnit(_)
            | Self::Leaning { .. }
            | Self::SignNotOne(_)
            | Self::SignMixed(_)
            | Self::SharedAcrossMirror(_)
            | Self::Outliers { .. } => true,
            Self::Differs(found) => {
                !matches!(found.difference, Difference::Rotated | Difference::OtherUvSet(_))
            }
            Self::Missing(_) | Self::Unused { .. } | Self::OtherRecipe { .. } => false,
        }
    }

    pub fn items(&self) -> Option<Items<'_>> {
        match self {
            Self::NotFinite(part)
            | Self::Zero(part)
            | Self::NotUnit(part)
            | Self::SignNotOne(part)
            | Self::SharedAcrossMirror(part)
            | Self::Outliers { vertices: part, .. } => Some(Items::Vertices(&part.items)),
            Self::Leaning { vertices, .. } => Some(Items::Vertices(vertices)),
            Self::SignMixed(part) => Some(Items::Triangles(&part.items)),
            Self::Differs(TangentDifference { items, .. }) if items.is_empty() => None,
            Self::Differs(TangentDifference { difference, items, .. }) if counts_vertices(*difference) => {
                Some(Items::Vertices(items))
            }
            Self::Differs(TangentDifference { items, .. }) => Some(Items::Triangles(items)),
            Self::Missing(_) | Self::Unused { .. } | Self::OtherRecipe { .. } => None,
        }
    }

    /// The indices of vertices.
    pub fn vertices_mut(&mut self) -> [Option<&mut Indices>; 2] {
        match self {
            Self::NotFinite(part)
            | Self::Zero(part)
            | Self::NotUnit(part)
            | Self::SignNotOne(part)
            | Self::SharedAcrossMirror(part)
            | Self::Outliers { vertices: part, .. } => [Some(&mut part.items), None],
            Self::Leaning { vertices, .. } => [Some(vertices), None],
            Self::Differs(TangentDifference { difference, items, exceptions, .. }) => {
                [Some(items).filter(|_| counts_vertices(*difference)), Some(exceptions)]
            }
            Self::Missing(_) | Self::Unused { .. } | Self::SignMixed(_) | Self::OtherRecipe { .. } => {
                [None, None]
            }
        }
    }
}

/// Whether the items of a difference are vertices. The other differences have triangles or no items.
fn counts_vertices(difference: Difference) -> bool {
    matches!(difference, Difference::PartlyNegated | Difference::PartlyRotated)
}

impl TangentDifference {
    pub fn percent(&self) -> f64 {
        100.0 * self.supporting as f64 / self.measured.max(1) as f64
    }

    /// Whether all corners that can be judged show it.
    pub fn is_on_all_corners(&self) -> bool {
        self.supporting == self.measured && !self.is_partial()
    }

    /// Whether it is about a part of the surface.
    pub fn is_partial(&self) -> bool {
        matches!(
            self.difference,
            Difference::SignPartlyFlipped | Difference::PartlyNegated | Difference::PartlyRotated
        )
    }

    fn code(&self) -> Code {
        match self.difference {
            Difference::SignFlipped => Code::TangentSignFlipped,
            Difference::SignFlippedWhereMirrored => Code::TangentSignFlippedWhereMirrored,
            Difference::SignPartlyFlipped => Code::TangentSignPartlyFlipped,
            Difference::PartlyRotated | Difference::Rotated => Code::TangentRotated,
            Difference::PartlyNegated | Difference::Negated => Code::TangentNegated,
            Difference::OtherUvSet(_) => Code::TangentOtherUvSet,
        }
    }
}

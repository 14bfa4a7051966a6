//! [`Defect`]: one thing that is wrong, with all its indices and numbers. Repairs read it; `words` says it.

mod maps;
mod obstacle;
mod pair;

use darboux::Recipe;

use crate::code::{Code, Family};
use crate::indices::{Indices, Part};
use crate::measure::fit::Difference;
use crate::measure::hard_edges::HardEdges;
use crate::measure::other_axes::OtherAxes;
use crate::measure::recipe::Recognised;
use crate::measure::reversal::Reversal;
use crate::measure::uv_scale::Outliers;
use crate::place::Place;
use crate::severity::Severity;

pub use maps::{
    Certainty, DirectionEvidence, FacesScore, LengthDoubt, MapFault, NoNormals, RedDoubt, ReliefEvidence,
    Texels,
};
pub use obstacle::Obstacle;
pub use pair::{Cancelled, PAIRS, Pair};

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Defect {
    pub place: Place,
    /// How bad it is here.
    pub severity: Severity,
    pub fault: Fault,
    /// Why a repair leaves it; none where it is repaired.
    pub obstacle: Option<Obstacle>,
    /// The mistake elsewhere that cancels it, so that bumps look right now.
    pub cancelled: Option<Cancelled>,
    /// In percent of the model's area: what it spoils, weighted by the angle; none where its severity does
    /// not depend on that.
    pub spoiled: Option<f64>,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// Positions contain NaN or infinity.
    PositionNotFinite(Part),
    /// The number of vertices without normals.
    NormalMissing(usize),
    NormalNotFinite(Part),
    NormalNotUnit {
        vertices: Part,
        /// The smallest length.
        smallest: f64,
    },
    NormalOtherAxes {
        axes: OtherAxes,
        vertices: usize,
    },
    /// Most triangles are wound against their normals.
    NormalsReversed {
        reversal: Reversal,
        triangles: Part,
    },
    /// The normals of some vertices point to the back of all faces around them.
    NormalsPartlyReversed {
        /// All triangles with such vertices.
        triangles: Part,
        /// The number of these whose normals all point to the back, and of those with normals on both sides.
        whole: usize,
        mixed: usize,
        vertices: usize,
        /// The number of connected parts with such vertices, and of all parts.
        parts: [usize; 2],
    },
    UvMissing {
        set: usize,
        /// The number of sets that are there.
        present: usize,
    },
    UvNotFinite {
        set: usize,
        vertices: Part,
    },
    UvDegenerate {
        set: usize,
        triangles: Part,
    },
    UvMirrored(Part),
    UvOverlapping {
        set: usize,
        triangles: Indices,
        /// Whether all pairs of triangles were compared.
        is_complete: bool,
        /// The share of the UV area.
        area_share: f64,
    },
    /// Faces whose UVs are stretched more than those of the others.
    UvStretched(Outliers),
    /// Faces with fewer texels than the others.
    UvCoarse(Outliers),
    /// Hard edges at which the UVs go on.
    UvHardEdge(HardEdges),
    /// The number of vertices without tangents.
    TangentMissing(usize),
    /// Tangents that nothing reads.
    TangentUnused {
        /// Their size.
        bytes: usize,
        /// What is wrong with them, each code once.
        also: Vec<Code>,
    },
    TangentNotFinite(Part),
    TangentZero(Part),
    TangentNotUnit(Part),
    TangentLeaning {
        vertices: Indices,
        /// The largest angle to the plane of the normal, in degrees.
        worst: f64,
    },
    TangentSignNotOne(Part),
    TangentSharedAcrossMirror(Part),
    /// Triangles with both signs.
    TangentSignMixed(Part),
    /// Directions or signs differ from MikkTSpace's in a known way.
    TangentDiffers(TangentDifference),
    /// Some tangents are not those of the method that made the others.
    TangentOutliers {
        recipe: Recipe,
        vertices: Part,
    },
    TangentOtherRecipe {
        recognised: Recognised,
        /// Where no known method made them: the percentage of corners that are far from MikkTSpace.
        far: f64,
    },
    Map(MapFault),
    TransformMirrors {
        /// Where the directions u and v of the texture go.
        axes: [[f64; 2]; 2],
        determinant: f64,
        /// Degrees.
        rotation: f64,
    },
    /// The negative scale of the normal texture.
    MapScaleNegative(f64),
    /// The scale of the normal texture is 0.
    MapScaleZero(f64),
    /// The large scale of the normal texture.
    MapScaleExtreme(f64),
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
    /// The UV set that the tangents should follow.
    pub uv_set: usize,
    /// Whether it follows from reversed normals.
    pub follows_from_normals: bool,
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
            Difference::None | Difference::Unknown => unreachable!("no difference is no defect"),
        }
    }
}

impl Fault {
    /// The kind of its finding.
    pub fn code(&self) -> Code {
        match self {
            Self::PositionNotFinite(_) => Code::PositionNotFinite,
            Self::NormalMissing(_) => Code::NormalMissing,
            Self::NormalNotFinite(_) => Code::NormalNotFinite,
            Self::NormalNotUnit { .. } => Code::NormalNotUnit,
            Self::NormalOtherAxes { .. } => Code::NormalOtherAxes,
            Self::NormalsReversed { .. } | Self::NormalsPartlyReversed { .. } => Code::NormalAgainstWinding,
            Self::UvMissing { .. } => Code::UvMissing,
            Self::UvNotFinite { .. } => Code::UvNotFinite,
            Self::UvDegenerate { .. } => Code::UvDegenerate,
            Self::UvMirrored(_) => Code::UvMirrored,
            Self::UvOverlapping { .. } => Code::UvOverlapping,
            Self::UvStretched(_) => Code::UvStretched,
            Self::UvCoarse(_) => Code::UvCoarse,
            Self::UvHardEdge(_) => Code::UvHardEdge,
            Self::TangentMissing(_) => Code::TangentMissing,
            Self::TangentUnused { .. } => Code::TangentUnused,
            Self::TangentNotFinite(_) => Code::TangentNotFinite,
            Self::TangentZero(_) => Code::TangentZero,
            Self::TangentNotUnit(_) => Code::TangentNotUnit,
            Self::TangentLeaning { .. } => Code::TangentNotPerpendicular,
            Self::TangentSignNotOne(_) => Code::TangentSignNotOne,
            Self::TangentSharedAcrossMirror(_) => Code::TangentSharedAcrossMirror,
            Self::TangentSignMixed(_) => Code::TangentSignMixed,
            Self::TangentDiffers(difference) => difference.code(),
            Self::TangentOutliers { .. } | Self::TangentOtherRecipe { .. } => Code::TangentOtherRecipe,
            Self::Map(fault) => fault.code(),
            Self::TransformMirrors { .. } => Code::TransformMirrors,
            Self::MapScaleNegative(_) => Code::MapScaleNegative,
            Self::MapScaleZero(_) => Code::MapScaleZero,
            Self::MapScaleExtreme(_) => Code::MapScaleExtreme,
        }
    }

    /// The vertices or triangles that show it; none for a property of the whole.
    pub fn items(&self) -> Option<&Indices> {
        match self {
            Self::PositionNotFinite(part)
            | Self::NormalNotFinite(part)
            | Self::NormalNotUnit { vertices: part, .. }
            | Self::NormalsReversed { triangles: part, .. }
            | Self::NormalsPartlyReversed { triangles: part, .. }
            | Self::UvNotFinite { vertices: part, .. }
            | Self::UvDegenerate { triangles: part, .. }
            | Self::UvMirrored(part)
            | Self::TangentNotFinite(part)
            | Self::TangentZero(part)
            | Self::TangentNotUnit(part)
            | Self::TangentSignNotOne(part)
            | Self::TangentSharedAcrossMirror(part)
            | Self::TangentSignMixed(part)
            | Self::TangentOutliers { vertices: part, .. } => Some(&part.items),
            Self::UvOverlapping { triangles: items, .. } | Self::TangentLeaning { vertices: items, .. } => {
                Some(items)
            }
            Self::UvStretched(faces) | Self::UvCoarse(faces) => Some(&faces.triangles),
            Self::UvHardEdge(edges) => Some(&edges.triangles),
            Self::TangentDiffers(difference) => Some(&difference.items).filter(|items| !items.is_empty()),
            _ => None,
        }
    }

    /// The number of vertices, corners, faces or texels that show it; 1 for a property of the whole.
    pub fn count(&self) -> usize {
        match self {
            Self::NormalOtherAxes { vertices, .. } => *vertices,
            Self::TangentDiffers(difference) => difference.supporting,
            Self::TangentOtherRecipe { recognised, .. } => {
                recognised.mikktspace.corners - recognised.mikktspace.close
            }
            Self::Map(fault) => fault.count(),
            _ => self.items().map_or(1, Indices::len),
        }
    }
}

/// Whether a defect is one of outliers, its code, and its place: primitive, material and image.
pub type Sameness = (bool, Code, (Option<(usize, usize)>, Option<usize>, Option<usize>));

impl Defect {
    /// A defect at no place yet, with the code's usual severity.
    pub fn new(fault: Fault) -> Self {
        let code = fault.code();
        let obstacle = code.left_because().map(|_| Obstacle::NoRepair(code));
        let (place, severity) = (Place::default(), code.severity());
        Self { place, severity, fault, obstacle, cancelled: None, spoiled: None }
    }

    pub fn code(&self) -> Code {
        self.fault.code()
    }

    /// The image of the map with which it is one finding, because two conventions cancel; none where it is a
    /// finding of its own.
    pub fn joint(&self) -> Option<Option<usize>> {
        match &self.cancelled {
            Some(Cancelled::ByMap { image, is_whole: true, .. }) => Some(*image),
            Some(Cancelled::BySurface { .. }) => Some(self.place.image),
            _ => None,
        }
    }

    /// The code under which it is reported.
    pub fn reported_code(&self) -> Code {
        if self.joint().is_some() { Code::ConventionsCancel } else { self.code() }
    }

    pub(crate) fn family(&self) -> Family {
        self.code().family()
    }

    /// Whether it can be repaired.
    pub fn is_fixable(&self) -> bool {
        self.obstacle.is_none()
    }

    /// Whether it is about the things that it lists, and not about the whole of its place.
    pub fn lists_items(&self) -> bool {
        self.fault.items().is_some()
    }

    /// The same with a reason, if there is one, why a repair leaves it. The first reason stays.
    #[must_use]
    pub fn with_obstacle(self, obstacle: Option<Obstacle>) -> Self {
        Self { obstacle: self.obstacle.or(obstacle), ..self }
    }

    /// The same with another severity.
    #[must_use]
    pub fn with_severity(self, severity: Severity) -> Self {
        Self { severity, ..self }
    }

    /// Whether two defects say the same of the same place. Tangents that are not those of the method that
    /// made the others are one thing, and that method is another.
    pub fn is_same(&self, other: &Self) -> bool {
        self.sameness() == other.sameness()
    }

    /// What two defects have in common that are the same ([`Defect::is_same`]).
    pub fn sameness(&self) -> Sameness {
        let primitive = self.place.primitive.as_ref().map(|name| (name.mesh, name.primitive));
        let place = (primitive, self.place.material, self.place.image);
        (matches!(self.fault, Fault::TangentOutliers { .. }), self.code(), place)
    }
}

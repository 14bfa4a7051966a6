//! [`Defect`]: one thing that is wrong, with all its indices and numbers. Repairs read it; `words` says it.

mod maps;
mod materials;
mod normals;
mod obstacle;
mod pair;
mod tangents;
mod uvs;

use crate::code::{Code, Family};
use crate::indices::{Items, Part};
use crate::place::Place;
use crate::severity::Severity;

pub use maps::{
    Certainty, DirectionEvidence, FacesScore, LengthDoubt, MapFault, NoNormals, RedDoubt, ReliefEvidence,
    Texels, Unread,
};
pub use materials::MaterialFault;
pub use normals::NormalFault;
pub use obstacle::{Assumption, Obstacle};
pub use pair::{Cancelled, PAIRS, Pair};
pub use tangents::{TangentDifference, TangentFault};
pub use uvs::UvFault;

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
    /// Why nothing shows it.
    pub unseen: Option<Unseen>,
    /// In percent of the model's area: the damage, weighted by the angle; none where its severity does
    /// not depend on that.
    pub damaged_percent: Option<f64>,
}

/// Why nothing shows a defect of a normal map, or of the tangents that it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unseen {
    /// All normal maps of the surface are flat; the image of one.
    FlatMap { image: usize },
    /// Every material with the map is unlit or scales it by 0.
    NoMaterial,
    /// No mesh of a node has the map.
    NotInScene,
}

/// What is wrong, by what it is about.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// Positions contain NaN or infinity.
    PositionNotFinite(Part),
    Normal(NormalFault),
    Uv(UvFault),
    Tangent(TangentFault),
    Map(MapFault),
    Material(MaterialFault),
}

impl Fault {
    /// The kind of its finding.
    pub fn code(&self) -> Code {
        match self {
            Self::PositionNotFinite(_) => Code::PositionNotFinite,
            Self::Normal(fault) => fault.code(),
            Self::Uv(fault) => fault.code(),
            Self::Tangent(fault) => fault.code(),
            Self::Map(fault) => fault.code(),
            Self::Material(fault) => fault.code(),
        }
    }

    /// The vertices or triangles that show it; none for a property of the whole.
    pub fn items(&self) -> Option<Items<'_>> {
        match self {
            Self::PositionNotFinite(part) => Some(Items::Vertices(&part.items)),
            Self::Normal(fault) => fault.items(),
            Self::Uv(fault) => fault.items(),
            Self::Tangent(fault) => fault.items(),
            Self::Map(_) | Self::Material(_) => None,
        }
    }

    /// The same, with vertices by their indices in the file. `in_file`: of each vertex.
    #[must_use]
    pub fn with_vertices(mut self, in_file: &[u32]) -> Self {
        let vertices = match &mut self {
            Self::PositionNotFinite(part) => [Some(&mut part.items), None],
            Self::Normal(fault) => [fault.vertices_mut(), None],
            Self::Uv(fault) => [fault.vertices_mut(), None],
            Self::Tangent(fault) => fault.vertices_mut(),
            Self::Map(_) | Self::Material(_) => [None, None],
        };
        vertices.into_iter().flatten().for_each(|indices| *indices = indices.numbered(in_file));
        self
    }

    /// The number of vertices, corners, faces or texels that show it; 1 for a property of the whole.
    pub fn count(&self) -> usize {
        match self {
            Self::Normal(NormalFault::OtherAxes { vertices, .. }) => *vertices,
            Self::Tangent(TangentFault::Differs(difference)) => difference.supporting,
            Self::Tangent(TangentFault::OtherRecipe { recognised, .. }) => {
                recognised.mikktspace.corners - recognised.mikktspace.close
            }
            Self::Map(fault) => fault.count(),
            _ => self.items().map_or(1, |items| items.indices().len()),
        }
    }
}

/// Implements conversions from the faults of each kind.
macro_rules! from_faults {
    ($($kind:ident($fault:ident))*) => {$(
        impl From<$fault> for Fault {
            fn from(fault: $fault) -> Self {
                Self::$kind(fault)
            }
        }
    )*};
}

from_faults! { Normal(NormalFault) Uv(UvFault) Tangent(TangentFault) Map(MapFault) Material(MaterialFault) }

/// Whether a defect is one of outliers, its code, and its place: primitive, material and image.
pub type Sameness = (bool, Code, (Option<(usize, usize)>, Option<usize>, Option<usize>));

impl Defect {
    /// A defect at no place yet, with the code's usual severity.
    pub fn new(fault: impl Into<Fault>) -> Self {
        let fault = fault.into();
        let code = fault.code();
        let obstacle = code.left_because().map(|_| Obstacle::NoRepair(code));
        let (place, severity) = (Place::default(), code.severity());
        Self { place, severity, fault, obstacle, cancelled: None, unseen: None, damaged_percent: None }
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

    /// The same with a reason, if there is one, why a repair leaves it.
    #[must_use]
    pub fn with_obstacle(mut self, obstacle: Option<Obstacle>) -> Self {
        obstacle.into_iter().for_each(|obstacle| self.leave(obstacle));
        self
    }

    /// Gives a reason why a repair leaves it. The first reason stays, unless the user's choice of codes
    /// overcomes that one.
    pub fn leave(&mut self, obstacle: Obstacle) {
        if self.obstacle.as_ref().is_none_or(Obstacle::yields_to_choice) {
            self.obstacle = Some(obstacle);
        }
    }

    /// The same in an image; `obstacle`: why it cannot be rewritten. No option overcomes that, so it takes
    /// the place of reasons that one would.
    #[must_use]
    pub fn in_image(self, obstacle: Option<&Obstacle>) -> Self {
        let is_free = self.obstacle.as_ref().is_none_or(Obstacle::depends_on_options);
        match obstacle.filter(|_| is_free) {
            Some(obstacle) => Self { obstacle: Some(obstacle.clone()), ..self },
            None => self,
        }
    }

    /// The same with another severity.
    #[must_use]
    pub fn with_severity(self, severity: Severity) -> Self {
        Self { severity, ..self }
    }

    /// The same for a map or a surface that nothing shows: information, unless tangents have no direction,
    /// which breaks the normals of renderers, too.
    #[must_use]
    pub fn that_is_unseen(self, why: Unseen) -> Self {
        let has_none = matches!(self.code(), Code::TangentNotFinite | Code::TangentZero);
        let is_read = matches!(self.family(), Family::Tangents | Family::Maps);
        if !is_read || has_none || self.severity == Severity::NotChecked {
            return self;
        }
        Self { unseen: Some(why), severity: self.severity.min(Severity::Info), damaged_percent: None, ..self }
    }

    /// Whether two defects say the same of the same place. Outliers among tangents are one thing, and the
    /// method of the other tangents is another.
    pub fn is_same(&self, other: &Self) -> bool {
        self.sameness() == other.sameness()
    }

    /// What two defects have in common that are the same ([`Defect::is_same`]).
    pub fn sameness(&self) -> Sameness {
        let primitive = self.place.primitive.as_ref().map(|name| (name.mesh, name.primitive));
        let place = (primitive, self.place.material, self.place.image);
        (matches!(self.fault, Fault::Tangent(TangentFault::Outliers { .. })), self.code(), place)
    }
}

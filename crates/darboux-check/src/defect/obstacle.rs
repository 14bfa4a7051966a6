//! [`Obstacle`]: why a repair leaves a defect.

use darboux::BitangentDirection;

use super::pair::Pair;
use crate::check_options::AssumedMap;
use crate::code::Code;
use crate::inverted::{Inverted, assumption};
use crate::measure::reversal::Undecided;

/// Why a repair leaves a defect. Directions are those where green should point: what a map may be is named as
/// seen from there.
#[derive(Clone, Debug, PartialEq)]
pub enum Obstacle {
    /// There is no repair for its code.
    NoRepair(Code),
    FlatShadingMayBeWanted,
    MorphTargetsMoveNormals,
    /// Nothing says whether faces or normals are reversed.
    UndecidedReversal(Undecided),
    /// All normals are in other axes, and new normals and tangents would not fit them.
    NormalsInOtherAxes,
    /// What turned the normals may have turned the tangents.
    TangentsMayBeTurned,
    /// The normals fit the faces in several ways nearly as well, or in none of them closely.
    AxesUnclear,
    /// The faces enclose a negative volume, so that they may be reversed, too.
    FacesMayBeReversed,
    /// Why tangents cannot be computed.
    NoTangents(String),
    DifferenceIsInvisible,
    BakedOnQuads,
    /// The tangents are those of another method, and right where the map was baked with them.
    MapMayFitTangents,
    /// The tangents may be older than the rounding of the UVs, and right.
    UvsWereRounded {
        steps: usize,
    },
    /// A map's vectors point against z, or along another axis.
    UndecidedOrder {
        is_z: bool,
    },
    EncodedAndInverted,
    XInAlpha,
    UnclearChannels,
    /// The probability of the direction, which is too small.
    Unsure(f64),
    OnlyAPartOfMap,
    /// The fine detail of the map is in the other convention.
    DetailIsOpposed,
    FacesLeanToRed(BitangentDirection),
    /// Inverted green and inverted red look alike; the one that is named is so likely.
    NotIdentified {
        probability: f64,
        wanted: BitangentDirection,
    },
    OnlyTheModelTells(BitangentDirection),
    /// One channel is inverted once red and green are exchanged back.
    ExchangedAndInverted(BitangentDirection),
    /// Bumps on the faces look the same as dents.
    MayBeDents(BitangentDirection),
    VectorsLean,
    MayBeNoMap,
    NegativeScale,
    /// The texture transform of a material mirrors or turns the image.
    TransformTurns,
    /// The red of another image is inverted, so that it may be here.
    RedLikelier {
        image: usize,
    },
    /// The convention of a map is unknown, and inverted green in it would cancel the defect.
    MapMayCancel {
        image: Option<usize>,
        /// Whether the file is from Sketchfab, most of whose maps do.
        is_from_sketchfab: bool,
        /// The probability that the map is right, where its texels tell.
        right: Option<f64>,
        /// What became of the user's assumption.
        assumption: Assumption,
        wanted: BitangentDirection,
    },
    /// The map was made for another UV layout, which the tangents may fit.
    MapHasOtherLayout {
        image: Option<usize>,
    },
    /// A mistake of the model cancels the mistake of the map.
    OnTheModelToo,
    /// Why an image cannot be rewritten, as a clause of darboux-io.
    NotRewritable(String),
    OtherImageFormat,
    /// A mistake elsewhere cancels it, and is left.
    PairIsLeft(&'static Pair),
    /// Flipped signs of a part of the surface are left, because a map may cancel them, and the repair would
    /// repair them, too.
    SignsAreLeft,
    /// The same where the code of the signs is not among those to repair.
    SignsAreNotChosen,
    /// It is a defect of the model with which an image was checked; a repair of the image does not change it.
    InTheModel,
    NotChosen,
    OtherMethodWanted,
    /// The rest needs all tangents computed again, and their recipe is kept.
    RecipeIsKept,
    NotRemoved,
    /// The repair would end in a new defect.
    WouldEndIn(Code),
    OnlyInvertedRedIsCertain,
    /// The sentence of the error that stopped the repair.
    Failed(String),
}

/// What becomes of what the user says of a map whose convention is not certain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assumption {
    None,
    /// The texels show otherwise.
    Contradicted,
    /// Green is inverted, or other channels, which the texels do not show.
    GreenInverted,
    OtherInverted,
}

impl Obstacle {
    /// Whether it is overcome where the code of the defect is chosen.
    pub fn yields_to_choice(&self) -> bool {
        matches!(self, Self::BakedOnQuads | Self::MapMayFitTangents)
    }

    /// Whether other options of the repair overcome it.
    pub fn depends_on_options(&self) -> bool {
        if self.yields_to_choice() {
            return true;
        }
        matches!(
            self,
            Self::NotChosen
                | Self::OtherMethodWanted
                | Self::NotIdentified { .. }
                | Self::RedLikelier { .. }
                | Self::OnlyTheModelTells(_)
                | Self::FacesLeanToRed(_)
                | Self::ExchangedAndInverted(_)
        )
    }

    /// What the user may say of the map where the picture looks as the finding says, so that it is repaired:
    /// that green is inverted, or beside flipped signs that the map is right.
    pub fn suggested_assumption(&self) -> Option<AssumedMap> {
        match self {
            Self::MapMayCancel {
                assumption: Assumption::None | Assumption::Contradicted, wanted, ..
            } => Some(assumption(Inverted::None, *wanted)),
            Self::NotIdentified { wanted, .. }
            | Self::FacesLeanToRed(wanted)
            | Self::OnlyTheModelTells(wanted)
            | Self::ExchangedAndInverted(wanted) => Some(assumption(Inverted::Green, *wanted)),
            _ => None,
        }
    }
}

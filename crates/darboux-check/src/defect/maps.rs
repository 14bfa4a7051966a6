//! [`MapFault`]: what is wrong with the texels of a normal map.

use darboux::{BitangentDirection, MapJudgement, SrgbMistake};

use crate::code::Code;
use crate::measure::contradiction::Contradiction;
use crate::measure::misreading::Misreading;
use crate::measure::padding::Padding;
use crate::measure::reordered::Reordered;
use crate::measure::seams::{Layout, SeamFit};
use crate::measure::storage::{BlockSteps, Enlargement, FewLevels};

/// A number of texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texels {
    pub count: usize,
    /// In percent of those that are no background.
    pub percent: f64,
}

/// How sure the derivatives of a map are of its convention.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certainty {
    /// The z score of the tiles' agreement.
    pub z_score: f64,
    /// The number of tiles that were compared.
    pub tiles: usize,
}

/// The z score that the faces of a model give an arrangement of the channels, and their number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacesScore {
    pub z_score: f64,
    pub faces: usize,
}

/// The evidence for the directions of the channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionEvidence {
    /// From 0 to 1.
    pub confidence: f32,
    pub correlation: f32,
    pub certainty: Certainty,
    pub relief: ReliefEvidence,
    /// The faces' verdict, where they decide.
    pub faces: Option<FacesScore>,
}

/// The evidence for the convention of the relief.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReliefEvidence {
    /// The mean correlation, weighted by the energy of slopes.
    pub correlation: f64,
    /// How much better a height field explains the slopes in that convention, in deviations of the same
    /// number for shifted channels.
    pub shift_score: f64,
    /// The shares of the slopes' energy that no height field explains, in OpenGL's and in DirectX's
    /// convention.
    pub residuals: [f64; 2],
}

impl ReliefEvidence {
    pub fn of(judgement: &MapJudgement) -> Self {
        Self {
            correlation: judgement.relief_correlation.into(),
            shift_score: judgement.shift_score.into(),
            residuals: judgement.residuals.map(f64::from),
        }
    }
}

/// Why inverted green may be inverted red.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RedDoubt {
    /// The faces of a model decide that it is green.
    None,
    /// The faces lean to red, without deciding it.
    FacesLeanToRed,
    /// The faces do not decide.
    FacesUndecided,
    /// No model is known.
    NoModel,
}

/// What texels are that are no normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoNormals {
    /// Black, white and middle grey.
    Background,
    /// One colour that is no normal: red, green, blue.
    OneColour([f64; 3]),
    MostlyImpossible,
    Picture,
    NoSlopes,
}

/// Why vectors of other lengths are not scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthDoubt {
    /// They lean to one side on average.
    Leaning,
    /// Nothing shows that they are slopes of a surface.
    NoSlopes,
}

/// Why a map has no texels to look at, each with a clause that says more.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unread {
    /// The decoder refuses the file.
    Damaged(String),
    /// There is no file where the model refers to one.
    Absent(String),
    /// The file is in a format that is not decoded here, so that nothing says that it is wrong.
    OtherFormat(String),
    /// The map was left out: it is on another machine, or beyond what a check decodes.
    LeftOut(String),
    /// The reader of another format than glTF left it out.
    NotCarried(String),
    /// Git LFS has not fetched the image.
    GitLfsPointer,
}

/// What is wrong with the texels of a normal map.
#[derive(Clone, Debug, PartialEq)]
pub enum MapFault {
    Unreadable {
        /// The name of the image's file, or of the image; empty for an image that is checked alone.
        name: String,
        why: Unread,
        /// 0 where there is no file.
        bytes: usize,
    },
    Height(Texels),
    ObjectSpace(Texels),
    /// The vectors point along another axis than z.
    Reordered {
        reordered: Reordered,
        /// The mean of that channel.
        mean: f32,
    },
    Srgb {
        /// None where a channel was inverted after the encoding.
        mistake: Option<SrgbMistake>,
        /// The commonest red and green, with the texels that have them.
        commonest: [u8; 2],
        texels: Texels,
    },
    /// As `Srgb`, by the lengths of the vectors: the percentage of vectors that are not unit, in the file and
    /// once the mistake is undone.
    SrgbByLength {
        mistake: SrgbMistake,
        not_unit: Texels,
        undone: f64,
    },
    NotNormal {
        kind: NoNormals,
        texels: Texels,
    },
    TwoChannel {
        /// Whether x is in alpha ("DXT5nm").
        is_x_in_alpha: bool,
        certainty: Certainty,
        misreading: Misreading,
    },
    /// Parts of the map are in other conventions than others.
    Contradiction {
        contradiction: Contradiction,
        wanted: BitangentDirection,
    },
    GreenFlipped {
        wanted: BitangentDirection,
        doubt: RedDoubt,
        evidence: DirectionEvidence,
    },
    RedFlipped(DirectionEvidence),
    /// The faces lean to inverted red and green, without deciding it.
    MayBeDents {
        wanted: BitangentDirection,
        score: FacesScore,
    },
    /// The fine detail is in another convention than the relief.
    DetailFlipped {
        /// Whether the relief has green up.
        is_relief_up: bool,
        evidence: ReliefEvidence,
    },
    ChannelsSwapped {
        /// Whether the derivatives show it; otherwise the faces do.
        by_derivatives: bool,
        log_energy_ratio: f32,
        /// The least parts of the slopes that no height field explains: of the channels as they are, and
        /// exchanged.
        residuals: [f32; 2],
        certainty: Certainty,
        faces: Option<FacesScore>,
    },
    NotUnit {
        texels: Texels,
        mean_length: f32,
        doubt: Option<LengthDoubt>,
    },
    NegativeZ(Texels),
    FlatOff {
        commonest: [u8; 2],
        /// The colour, where the whole map has one.
        colour: Option<[f64; 3]>,
        degrees: f64,
        texels: Texels,
    },
    /// In percent, the texels of the commonest colour.
    Flat(f64),
    /// Every texel is there several times.
    Enlarged(Enlargement),
    /// The channels have few levels.
    Banding(FewLevels),
    /// The borders of the blocks of a compression show.
    Blocks(BlockSteps),
    /// Borders of charts are lit wrongly in smaller mip levels.
    Padding(Padding),
    /// The map fits the seams of the meshes in another layout, and not as it is.
    OtherLayout {
        layout: Layout,
        /// How it fits so, and as it is.
        fits: [SeamFit; 2],
        /// The points that were compared.
        points: usize,
    },
}

impl MapFault {
    pub(super) fn code(&self) -> Code {
        match self {
            Self::Unreadable { .. } => Code::MapUnreadable,
            Self::Height(_) => Code::MapHeight,
            Self::ObjectSpace(_) => Code::MapObjectSpace,
            Self::Reordered { reordered, .. } if reordered.is_z() => Code::MapNegativeZ,
            Self::Reordered { .. } | Self::ChannelsSwapped { .. } => Code::MapChannelsSwapped,
            Self::Srgb { .. } | Self::SrgbByLength { .. } => Code::MapSrgb,
            Self::NotNormal { .. } => Code::MapNotNormal,
            Self::TwoChannel { .. } => Code::MapTwoChannel,
            Self::Contradiction { .. } | Self::GreenFlipped { .. } => Code::MapGreenFlipped,
            Self::RedFlipped(_) => Code::MapRedFlipped,
            Self::MayBeDents { .. } => Code::MapMayBeDents,
            Self::DetailFlipped { .. } => Code::MapDetailFlipped,
            Self::NotUnit { .. } => Code::MapNotUnit,
            Self::NegativeZ(_) => Code::MapNegativeZ,
            Self::FlatOff { .. } => Code::MapFlatOff,
            Self::Flat(_) => Code::MapFlat,
            Self::OtherLayout { .. } => Code::MapOtherLayout,
            Self::Enlarged(_) => Code::MapEnlarged,
            Self::Banding(_) => Code::MapBanding,
            Self::Blocks(_) => Code::MapBlocks,
            Self::Padding(_) => Code::MapPadding,
        }
    }

    pub(super) fn count(&self) -> usize {
        match self {
            Self::Height(texels)
            | Self::ObjectSpace(texels)
            | Self::Srgb { texels, .. }
            | Self::SrgbByLength { not_unit: texels, .. }
            | Self::NotNormal { texels, .. }
            | Self::NotUnit { texels, .. }
            | Self::NegativeZ(texels)
            | Self::FlatOff { texels, .. } => texels.count,
            Self::Contradiction { contradiction, wanted } => {
                contradiction.wrong(*wanted).blocks * contradiction.side * contradiction.side
            }
            _ => 1,
        }
    }
}

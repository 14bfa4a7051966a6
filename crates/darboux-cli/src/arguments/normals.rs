//! `darboux normals`, and the choice of normals that other commands share.

use clap::{Args, ValueEnum};
use darboux::{NormalOptions, NormalWeight, Shading, SmoothingSeams};

use super::{Files, Talk, degrees};

pub(super) const ABOUT: &str = "\
Add normals to glTF and GLB files.

Every triangle primitive without normals gets some; with --overwrite all get new ones. Primitives of one mesh are shaded as one \
surface: vertices at equal positions are one, so that UV seams and material borders do not show. Vertices are split where corners \
need different normals (flat shading, creases); skins, colours, UV sets and morph targets follow. Tangents of the old normals are \
taken out: run darboux tangents afterwards, or use its --normals. Everything else stays as it was.

Without -o, --out-dir or --in-place the output lies beside its input: model.glb becomes model.normals.glb.";

pub(super) const EXAMPLES: &str = "\
Examples:
  darboux normals scan.glb                               smooth everywhere
  darboux normals part.glb --normals crease=30           hard edges above 30 degrees
  darboux normals part.glb --normals crease=30 --weight angle-area
                                                         bevels bend, wide faces stay flat
  darboux normals level.glb --overwrite --normals flat   as if there were none";

/// `darboux normals`.
#[derive(Debug, Args)]
pub struct NormalsArguments {
    #[command(flatten)]
    pub files: Files,

    /// flat, smooth, or crease=DEG: smooth but for edges that are sharper than so many degrees
    #[arg(long, value_name = "SHADING", default_value = "smooth", value_parser = shading, help_heading = "Normals")]
    pub normals: ShadingChoice,

    /// How much each face counts at a vertex of a smooth surface
    #[arg(long, value_enum, default_value_t, help_heading = "Normals")]
    pub weight: Weight,

    /// Vertices stay apart where the index list has them apart, at equal positions too
    #[arg(long, help_heading = "Normals")]
    pub respect_seams: bool,

    /// Replace normals that exist; without it such primitives are kept
    #[arg(long, help_heading = "Normals")]
    pub overwrite: bool,

    #[command(flatten)]
    pub talk: Talk,
}

impl NormalsArguments {
    /// The options of the core.
    pub fn shading(&self) -> NormalOptions {
        let seams = if self.respect_seams { SmoothingSeams::Respected } else { SmoothingSeams::Ignored };
        NormalOptions { weight: self.weight.into(), seams, ..self.normals.options() }
    }
}

/// Flat, smooth or creased.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShadingChoice {
    Flat,
    Smooth,
    Crease(f32),
}

impl ShadingChoice {
    /// The options of the core.
    pub fn options(self) -> NormalOptions {
        let smooth = NormalOptions::default();
        match self {
            Self::Flat => NormalOptions { shading: Shading::Flat, ..smooth },
            Self::Smooth => smooth,
            Self::Crease(crease) => NormalOptions { crease, ..smooth },
        }
    }
}

/// The normals that tangents are computed with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalsChoice {
    Keep,
    Make(ShadingChoice),
}

impl NormalsChoice {
    /// The options of the core, unless normals stay as they are.
    pub fn options(self) -> Option<NormalOptions> {
        match self {
            Self::Keep => None,
            Self::Make(shading) => Some(shading.options()),
        }
    }
}

/// `--weight`: [`NormalWeight`] as people type it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Weight {
    /// The angle of its corner: independent of how a flat surface is cut
    #[default]
    Angle,
    /// Its area
    Area,
    /// Both: wide faces stay flat beside bevels
    AngleArea,
}

impl From<Weight> for NormalWeight {
    fn from(weight: Weight) -> Self {
        match weight {
            Weight::Angle => Self::Angle,
            Weight::Area => Self::Area,
            Weight::AngleArea => Self::AngleArea,
        }
    }
}

fn shading(text: &str) -> Result<ShadingChoice, String> {
    match (text, text.strip_prefix("crease=").map(degrees::<f32>)) {
        ("flat", _) => Ok(ShadingChoice::Flat),
        ("smooth", _) => Ok(ShadingChoice::Smooth),
        (_, Some(Ok(degrees))) => Ok(ShadingChoice::Crease(degrees)),
        (_, Some(Err(_))) => Err("a crease has 0 to 180 degrees, as in crease=30".into()),
        _ => Err("choose flat, smooth or crease=DEG".into()),
    }
}

/// A shading, or "keep".
pub(super) fn normals_choice(text: &str) -> Result<NormalsChoice, String> {
    if text == "keep" {
        return Ok(NormalsChoice::Keep);
    }
    let made = shading(text).map(NormalsChoice::Make);
    made.map_err(|problem| problem.replace("choose flat", "choose keep, flat"))
}

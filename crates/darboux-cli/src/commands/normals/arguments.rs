//! The arguments of `darboux normals`.

use clap::{Args, ValueEnum};
use darboux::{NormalOptions, NormalWeight, SmoothingSeams};

use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;
use crate::options::shading::{ShadingChoice, shading};

pub const ABOUT: &str = "\
Add normals to glTF and GLB files.

Every triangle primitive without normals gets some; with --overwrite all get new ones. Primitives of one mesh are shaded as one \
surface: vertices at equal positions are one, so that UV seams and material borders do not show. Vertices are split where corners \
need different normals (flat shading, creases); skins, colours, UV sets and morph targets follow. Tangents of the old normals are \
taken out: run darboux tangents afterwards, or use its --normals. Everything else stays as it was.

Without -o, --out-dir or --in-place the output lies beside its input: model.glb becomes model.normals.glb.";

pub const EXAMPLES: &str = "\
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
    pub files: FileOptions,

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
    pub messages: MessageOptions,
}

impl NormalsArguments {
    /// The options of the core.
    pub fn shading(&self) -> NormalOptions {
        let seams = if self.respect_seams { SmoothingSeams::Respected } else { SmoothingSeams::Ignored };
        self.normals.options().with_weight(self.weight.into()).with_seams(seams)
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

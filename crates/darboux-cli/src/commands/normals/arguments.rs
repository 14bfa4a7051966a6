//! The arguments of `darboux normals`.

use clap::Args;
use darboux::{Choice, NormalOptions, NormalWeight, SmoothingSeams};

use crate::options::choice::choice;
use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;
use crate::options::shading::{ShadingChoice, shading};

pub const ABOUT: &str = "\
Add normals to models.

Every triangle primitive without normals gets normals; with --overwrite all primitives get new ones. The \
primitives of a mesh are shaded as one surface: vertices at equal positions count as one, so that UV seams \
and material borders are invisible. Vertices are split where their corners need different normals (flat \
shading, creases); skins, colours, UV sets and morph targets are split with them. Tangents that belong to \
replaced normals are removed: run darboux tangents afterwards, or use its option --normals. The rest of the \
file does not change.

Without -o, --out-dir or --in-place the output is written beside its input: model.glb becomes \
model.normals.glb.";

pub const EXAMPLES: &str = "\
Examples:
  darboux normals scan.glb                               smooth everywhere
  darboux normals part.glb --normals crease=30           hard edges above 30 degrees
  darboux normals part.glb --normals crease=30 --weight angle-area
                                                         round bevels, flat wide faces
  darboux normals level.glb --overwrite --normals flat   replace existing normals";

/// Which normals are generated.
#[derive(Debug, Args)]
pub struct NormalsArguments {
    #[command(flatten)]
    pub files: FileOptions,

    /// flat, smooth, or crease=DEG: smooth except at edges sharper than DEG degrees
    #[arg(long, value_name = "SHADING", default_value = "smooth", value_parser = shading, help_heading = "Normals")]
    pub normals: ShadingChoice,

    /// The weight of each face at a smooth vertex
    #[arg(
        long,
        value_parser = choice::<NormalWeight>(),
        default_value = NormalWeight::default().name(),
        help_heading = "Normals"
    )]
    pub weight: NormalWeight,

    /// Do not smooth across vertices with different indices, even at equal positions
    #[arg(long, help_heading = "Normals")]
    pub respect_seams: bool,

    /// Replace existing normals; without it they are kept
    #[arg(long, help_heading = "Normals")]
    pub overwrite: bool,

    #[command(flatten)]
    pub messages: MessageOptions,
}

impl NormalsArguments {
    /// The options of the library.
    pub fn shading(&self) -> NormalOptions {
        let seams = if self.respect_seams { SmoothingSeams::Respected } else { SmoothingSeams::Ignored };
        self.normals.options().with_weight(self.weight).with_seams(seams)
    }
}

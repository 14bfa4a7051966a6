//! The arguments of `darboux compare`.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

use crate::options::angle::degrees;
use crate::options::messages::MessageOptions;
use crate::options::method::MethodName;
use crate::options::reading::ReadOptions;

pub const ABOUT: &str = "\
Compare the tangents of two files of one model, or of a file with those of a method.

Corner by corner: the angles between tangents (least, median, 95th percentile, greatest, mean, mean weighted by area), flipped \
signs, a histogram, and the worst places. Vertices may be split differently in the two files; corners must be the same, in the \
same order. Primitives are matched by the numbers of mesh and primitive.

Exit codes: 0 compared, 1 a file is bad or they are of different models, 2 wrong usage, 3 compared, and further apart than --tolerance.";

pub const EXAMPLES: &str = "\
Examples:
  darboux compare exported.glb model.tangents.glb       whose tangents are these?
  darboux compare model.glb --method mikktspace         are they MikkTSpace's? exact, if all are identical
  darboux compare a.glb b.glb --heat-map worst.png      where, over the UV layout
  darboux compare a.glb b.glb --tolerance 0.1 --quiet   in a script: exit code 3 if not";

/// `darboux compare`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("with").args(["second", "method"]).required(true))]
pub struct CompareArguments {
    /// The first file (.gltf, .glb, .vrm)
    #[arg(value_name = "A")]
    pub first: PathBuf,

    /// The second file
    #[arg(value_name = "B")]
    pub second: Option<PathBuf>,

    /// Compare A with the tangents that this method gives it; `darboux methods` lists them
    #[arg(long, value_enum, value_name = "NAME")]
    pub method: Option<MethodName>,

    /// How many of the worst places are listed
    #[arg(long, value_name = "COUNT", default_value_t = 5)]
    pub worst: usize,

    /// Exit with 3 if an angle is greater than so many degrees, a sign is flipped, or tangents are missing on one side
    #[arg(long, value_name = "DEGREES", value_parser = degrees::<f64>, allow_negative_numbers = true)]
    pub tolerance: Option<f64>,

    /// Draw the angles over the UV layout, as a PNG
    #[arg(long, value_name = "FILE")]
    pub heat_map: Option<PathBuf>,

    /// Replace a heat map that exists
    #[arg(long, requires = "heat_map")]
    pub force: bool,

    #[command(flatten)]
    pub reading: ReadOptions,

    #[command(flatten)]
    pub messages: MessageOptions,
}

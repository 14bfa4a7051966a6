//! The arguments of `darboux compare`.

use std::path::PathBuf;

use clap::{ArgGroup, Args};
use darboux::Method;

use crate::options::angle::degrees;
use crate::options::choice::choice;
use crate::options::formats::with_endings;
use crate::options::messages::MessageOptions;
use crate::options::reading::ReadOptions;

pub const ABOUT: &str = "\
Compare the tangents of two files of one model, or of a file with those of a method.

Prints, over all corners, the angles between the tangents (minimum, median, 95th percentile, maximum, mean, \
mean weighted by area), the number of opposite signs w, a histogram of the angles, and the worst corners. An \
angle is between the directions of two tangents, whatever their signs. The two files may split vertices \
differently, but must have the same corners in the same order. Primitives are matched by the indices of mesh \
and primitive.

Exit codes: 0 compared, 1 a file is bad or the models differ, 2 wrong usage, 3 the difference is larger than \
--tolerance.";

pub const USAGE: &str = "\
darboux compare [OPTIONS] <A> <B>
       darboux compare [OPTIONS] <A> --method <NAME>";

pub const EXAMPLES: &str = "\
Examples:
  darboux compare exported.glb model.tangents.glb       do two files have the same tangents?
  darboux compare model.glb --method mikktspace         are the tangents MikkTSpace's, bit for bit?
  darboux compare a.glb b.glb --heat-map worst.png      where do they differ? a picture of the UV layout
  darboux compare a.glb b.glb --tolerance 0.1 --quiet   for scripts: exit code 3 if they differ by more";

/// Which tangents are compared, and what is reported.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("with").args(["second", "method"]).required(true))]
pub struct CompareArguments {
    #[arg(value_name = "A", help = with_endings("The first file ({models})"))]
    pub first: PathBuf,

    /// The second file
    #[arg(value_name = "B")]
    pub second: Option<PathBuf>,

    /// Compare A with the tangents that this method computes for A; `darboux methods` lists the methods
    #[arg(long, value_parser = choice::<Method>(), value_name = "NAME")]
    pub method: Option<Method>,

    /// How many of the worst corners are listed
    #[arg(long, value_name = "COUNT", default_value_t = 5)]
    pub worst: usize,

    /// Exit with 3 if an angle is larger than this, a sign w is opposite, or one side lacks tangents
    #[arg(long, value_name = "DEGREES", value_parser = degrees::<f64>, allow_negative_numbers = true)]
    pub tolerance: Option<f64>,

    /// Draw the angles over the UV layout, as a PNG
    #[arg(long, value_name = "PNG")]
    pub heat_map: Option<PathBuf>,

    /// Replace a heat map that exists
    #[arg(long, requires = "heat_map")]
    pub force: bool,

    #[command(flatten)]
    pub reading: ReadOptions,

    #[command(flatten)]
    pub messages: MessageOptions,
}

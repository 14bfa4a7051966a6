//! The arguments of `darboux report`.

use std::path::PathBuf;

use clap::Args;

use crate::commands::check::arguments::FindingOptions;
use crate::commands::check::html::DEFAULT_PICTURES;
use crate::options::formats::with_endings;
use crate::options::reading::ReadOptions;

pub const ABOUT: &str = "\
Write what is wrong with models as one HTML file with pictures.

Checks as `darboux check` does. The page begins with the diagnosis of each file; below it are two pictures, \
of the file and of what `darboux check --fix` would write, under one slider, from the side on which they \
differ most; then the findings, one entry per kind. The page is one file and loads nothing from a network, \
so CI can keep it and people can send it. No model is changed.\n\n\
Pictures are drawn by the adapter of `darboux render`, which may be software (Mesa's lavapipe). Without an \
adapter the page says so and has the findings alone.\n\n\
Exit codes are those of `darboux check`: 0: no finding is as severe as --fail-on says (by default error); 1: \
one is, or a file cannot be read; 2: the command line is wrong.";

pub const EXAMPLES: &str = "\
Examples:
  darboux report model.glb -o report.html
  darboux report models/ -o report.html --force --fail-on never
  darboux report a.glb b.glb -o report.html --allow tangent-other-recipe";

/// What is checked, and where the page goes.
#[derive(Debug, Args)]
pub struct ReportArguments {
    #[arg(required = true, value_name = "INPUT", help = with_endings("Models ({models}), folders of models, \
         and normal maps (.png, .jpg, .webp, .tga)"))]
    pub inputs: Vec<PathBuf>,

    /// The page, in an existing folder
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub output: PathBuf,

    /// Replace the page if it exists
    #[arg(long, help_heading = "Output")]
    pub force: bool,

    /// How many files have pictures: the worst ones
    #[arg(long, value_name = "NUMBER", default_value_t = DEFAULT_PICTURES, help_heading = "Output")]
    pub pictures: usize,

    #[command(flatten)]
    pub findings: FindingOptions,

    #[command(flatten, next_help_heading = "Input")]
    pub reading: ReadOptions,

    /// Print errors only
    #[arg(short, long, help_heading = "Messages")]
    pub quiet: bool,
}

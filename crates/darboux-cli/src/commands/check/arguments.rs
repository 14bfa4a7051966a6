//! The arguments of `darboux check`.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use darboux::{Choice, Method};
use darboux_check::{AssumedMap, CheckOptions, Code, MapConvention, Severity};

use crate::inputs::UsageError;
use crate::options::choice::choice;
use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;
use crate::options::shading::{ShadingChoice, shading};

pub const ABOUT: &str = "\
Say what is wrong with models and normal maps, and repair it.

Checks the tangents, normals and UVs of every primitive, how the tangents were computed, and the texels of \
every normal map: whether green points up (OpenGL) or down (DirectX), and whether they are normals at all. \
Every finding has a code, numbers as evidence, what it looks like on screen and the cure. Images (.png, \
.jpg, .webp, .tga) are checked as normal maps.\n\n\
Without --fix no file is written. With --fix the repaired file is written beside its input, model.glb as \
model.fixed.glb, unless -o, --out-dir or --in-place says otherwise; what cannot be repaired without guessing \
is left, and the reason printed. Nothing is left to repair in the repaired file. Where nothing is repaired, \
only -o and --out-dir write a copy, of models and of images that could be repaired (PNG, JPEG and TGA; WebP \
images are read and never written). In a folder, files named like repaired ones (model.fixed.glb) are \
skipped, and one that an earlier run has written is kept if it is still what would be written.\n\n\
The report begins with a diagnosis: what happened, what it looks like, and what to type. Findings of one \
kind are one entry; -v prints each of them.\n\n\
Exit codes: 0: no finding is as severe as --fail-on says (by default error) or all that were are repaired; \
1: one is, or a file cannot be read; 2: the command line is wrong. Maps in a format that is not read are not \
checked, and fail nothing. docs/check.md lists all codes.";

pub const INPUTS: &str =
    "Models ({models}), folders of models, and normal maps (.png, .jpg, .webp, .tga); - is standard input";

pub const EXAMPLES: &str = "\
Examples:
  darboux check model.glb
  darboux check models/ --fail-on warning
  darboux check brick_normal.png                     is it OpenGL's or DirectX's?
  darboux check brick_normal.png --model wall.glb    does it fit this model?
  darboux check brick_normal.png --model wall.glb --fix
  darboux check level.glb --allow tangent-other-recipe,map-flat
  darboux check models/ --report report.html         with pictures, for a pull request
  darboux check --explain tangent-sign-flipped
  darboux check model.glb --fix                      writes model.fixed.glb
  darboux check model.glb --fix --assume map=directx what the file does not decide
  darboux check model.glb --fix --dry-run            what would be edited?
  darboux check models/ --fix --in-place --only tangent-sign-flipped,map-green-flipped
  darboux check models/ --json | jq '.files[].findings[] | select(.severity == \"error\")'";

/// What is checked, and which findings are reported.
#[derive(Debug, Args)]
pub struct FindingOptions {
    /// Report these codes only
    #[arg(
        long,
        value_name = "CODE,...",
        value_delimiter = ',',
        value_parser = code(),
        hide_possible_values = true,
        help_heading = "Findings"
    )]
    pub only: Vec<Code>,

    /// Do not report these codes
    #[arg(
        long,
        value_name = "CODE,...",
        value_delimiter = ',',
        value_parser = code(),
        hide_possible_values = true,
        help_heading = "Findings"
    )]
    pub allow: Vec<Code>,

    /// The severity from which on a finding makes the exit code 1
    #[arg(long, value_enum, default_value_t, value_name = "SEVERITY", help_heading = "Findings")]
    pub fail_on: FailOn,

    /// Where the green of normal maps should point
    #[arg(
        long,
        value_parser = choice::<MapConvention>(),
        value_name = "CONVENTION",
        default_value = MapConvention::default().name(),
        help_heading = "Findings"
    )]
    pub convention: MapConvention,

    /// What normal maps are where neither their texels nor the faces of the model decide it; what the texels
    /// show is not overruled
    #[arg(long, value_name = "WHAT", value_parser = assumption(), help_heading = "Findings")]
    pub assume: Option<AssumedMap>,

    /// Do not decode normal maps: they are taken to be right
    #[arg(long, help_heading = "Findings")]
    pub no_maps: bool,
}

/// Which files are checked, and for what.
#[derive(Debug, Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub files: FileOptions,

    /// Print the meaning of a code and exit
    #[arg(long, value_name = "CODE", value_parser = code(), hide_possible_values = true, conflicts_with = "inputs")]
    pub explain: Option<Code>,

    #[command(flatten)]
    pub findings: FindingOptions,

    /// The model that the images are normal maps of: its faces tell inverted green from inverted red, and
    /// its tangents, normals and UVs are checked, too
    #[arg(long, value_name = "MODEL", help_heading = "Findings")]
    pub model: Option<PathBuf>,

    /// Repair what is found, and write the result
    ///
    /// Wrong tangents are corrected in the way that the others were computed, all are made again where all
    /// are wrong, vertices split, normals made or flipped, and the texels of PNG maps rewritten at their
    /// bit depth; a palette becomes RGB, and a JPEG map a PNG. Tangents of a known method other than
    /// MikkTSpace are left, and those of no known method unless many point to wrong directions, because the
    /// map may have been baked with them: --only tangent-other-recipe or another --method computes them
    /// again. Only the findings that are reported are repaired (--only, --allow). Everything else in the
    /// file is kept, byte for byte; a compressed model is written without compression if anything is
    /// repaired.
    #[arg(long, help_heading = "Repair")]
    pub fix: bool,

    /// Print the edits with which --fix would begin, and write no file
    #[arg(long, requires = "fix", help_heading = "Repair")]
    pub dry_run: bool,

    /// How --fix makes tangents again: as the normal map was baked, so nearly always mikktspace
    #[arg(
        long,
        value_parser = choice::<Method>(),
        value_name = "NAME",
        default_value = Method::default().name(),
        requires = "fix",
        help_heading = "Repair"
    )]
    pub method: Method,

    /// How --fix makes missing normals: flat, smooth or crease=DEG
    #[arg(
        long,
        value_name = "SHADING",
        default_value = "smooth",
        value_parser = shading,
        requires = "fix",
        help_heading = "Repair"
    )]
    pub normals: ShadingChoice,

    /// Write what is found as one HTML file with pictures, which needs no network
    ///
    /// The same file as `darboux report` writes. An existing report is replaced.
    #[arg(long, value_name = "FILE", conflicts_with = "fix", help_heading = "Messages")]
    pub report: Option<PathBuf>,

    #[command(flatten)]
    pub messages: MessageOptions,
}

/// Parses a code; clap suggests the most similar one for another word.
fn code() -> impl TypedValueParser<Value = Code> {
    PossibleValuesParser::new(Code::ALL.iter().map(|code| code.name())).try_map(|name| name.parse())
}

/// Parses `map=NAME`.
fn assumption() -> impl TypedValueParser<Value = AssumedMap> {
    let name = |map: AssumedMap| format!("map={}", map.name());
    let values = AssumedMap::ALL.iter().map(|&map| PossibleValue::new(name(map)).help(map.summary()));
    PossibleValuesParser::new(values).try_map(|name| name.trim_start_matches("map=").parse::<AssumedMap>())
}

impl FindingOptions {
    /// The options of the check.
    pub fn check_options(&self) -> CheckOptions {
        CheckOptions::default()
            .with_green(self.convention.green())
            .with_maps(!self.no_maps)
            .with_assumed_map(self.assume)
    }

    /// Refuses a code that is both wanted and not.
    pub fn refuse_contradictions(&self) -> Result<(), UsageError> {
        match self.only.iter().find(|code| self.allow.contains(code)) {
            Some(code) => Err(UsageError(format!("--only and --allow both name {code}; name it once"))),
            None => Ok(()),
        }
    }

    /// Whether findings with a code are reported and repaired.
    pub fn reports(&self, code: Code) -> bool {
        (self.only.is_empty() || self.only.contains(&code)) && !self.allow.contains(&code)
    }
}

/// `--fail-on`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum FailOn {
    /// A picture is wrong
    #[default]
    Error,
    /// A picture may be wrong
    Warning,
    /// Findings do not change the exit code
    Never,
}

impl FailOn {
    /// Whether a finding of a severity makes the exit code 1.
    pub fn includes(self, severity: Severity) -> bool {
        match self {
            Self::Error => severity >= Severity::Error,
            Self::Warning => severity >= Severity::Warning,
            Self::Never => false,
        }
    }
}

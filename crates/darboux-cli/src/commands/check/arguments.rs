//! The arguments of `darboux check`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use darboux::BitangentDirection;
use darboux_check::{Code, Severity};

use crate::options::messages::MessageOptions;
use crate::options::reading::ReadOptions;

pub const ABOUT: &str = "\
Say what is wrong with models and normal maps. No file is written.

Checks the tangents, normals and UVs of every primitive, how the tangents were computed, and the texels of every normal map: whether green points \
up (OpenGL) or down (DirectX), and whether they are normals at all. Every finding has a code, numbers as evidence, what it looks like on screen and \
the cure. Images (.png, .jpg, .webp) are checked as normal maps.\n\n\
The exit code is 1 if a file cannot be read or a finding is at least as severe as --fail-on says. docs/check.md lists all codes.";

pub const EXAMPLES: &str = "\
Examples:
  darboux check model.glb
  darboux check models/ --fail-on warning
  darboux check brick_normal.png                     is it OpenGL's or DirectX's?
  darboux check level.glb --allow tangent-other-recipe,map-flat
  darboux check --explain tangent-sign-flipped
  darboux check models/ --json | jq '.files[].findings[] | select(.severity == \"error\")'";

/// Which files are checked, and for what.
#[derive(Debug, Args)]
pub struct CheckArguments {
    /// Models (.gltf, .glb, .vrm), folders of models, and normal maps (.png, .jpg, .webp); - is standard input
    #[arg(required_unless_present = "explain", value_name = "FILE")]
    pub inputs: Vec<PathBuf>,

    /// Print the meaning of a code and exit
    #[arg(long, value_name = "CODE", conflicts_with = "inputs")]
    pub explain: Option<Code>,

    /// Report these codes only
    #[arg(long, value_name = "CODE,...", value_delimiter = ',', help_heading = "Findings")]
    pub only: Vec<Code>,

    /// Do not report these codes
    #[arg(long, value_name = "CODE,...", value_delimiter = ',', help_heading = "Findings")]
    pub allow: Vec<Code>,

    /// The severity from which on a finding makes the exit code 1
    #[arg(long, value_enum, default_value_t, value_name = "SEVERITY", help_heading = "Findings")]
    pub fail_on: FailOn,

    /// Where the green of normal maps should point
    #[arg(long, value_enum, default_value_t, value_name = "CONVENTION", help_heading = "Findings")]
    pub convention: MapConvention,

    /// Do not decode normal maps
    #[arg(long, help_heading = "Findings")]
    pub no_maps: bool,

    /// The number of files that are checked at the same time; by default one per core
    #[arg(short, long, value_name = "COUNT")]
    pub jobs: Option<NonZeroUsize>,

    #[command(flatten)]
    pub reading: ReadOptions,

    #[command(flatten)]
    pub messages: MessageOptions,
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

/// `--convention`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum MapConvention {
    /// Green up: glTF, OpenGL, Blender, Unity, Godot
    #[default]
    #[value(name = "opengl")]
    OpenGl,
    /// Green down: DirectX, Unreal
    #[value(name = "directx")]
    DirectX,
}

impl From<MapConvention> for BitangentDirection {
    fn from(convention: MapConvention) -> Self {
        match convention {
            MapConvention::OpenGl => Self::Up,
            MapConvention::DirectX => Self::Down,
        }
    }
}

//! The one definition of the command line. Help, man pages, completions and docs/cli.md are generated from it.

use std::path::PathBuf;

use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum};

/// Tangents for normal-mapped glTF models: MikkTSpace bit for bit, seams split
#[derive(Debug, Parser)]
#[command(name = "darboux", version, about, long_about = LONG_ABOUT, arg_required_else_help = true, max_term_width = 100)]
pub struct Arguments {
    /// What to do
    #[command(subcommand)]
    pub command: Command,
}

const LONG_ABOUT: &str = "\
Tangents for normal-mapped glTF models: MikkTSpace bit for bit, seams split.

A normal map looks right only when the renderer's tangents are the baker's. Darboux computes MikkTSpace tangents, \
as bakers do, and writes them into .gltf and .glb files without changing anything else.

Messages go to standard error. Exit codes: 0 done (nothing to do included), 1 an input is bad or a file failed, \
2 wrong usage.";

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Add tangents to glTF and GLB files
    #[command(long_about = TANGENTS_ABOUT, after_long_help = TANGENTS_EXAMPLES)]
    Tangents(TangentsArguments),
    /// Show what each primitive holds and what its tangents would meet
    #[command(long_about = INSPECT_ABOUT, after_long_help = INSPECT_EXAMPLES)]
    Inspect(InspectArguments),
}

const TANGENTS_ABOUT: &str = "\
Add tangents to glTF and GLB files.

Every triangle primitive with positions, normals and UVs gets MikkTSpace tangents for the UV set that its normal map uses. \
Vertices are split where corners need different tangents (mirrored seams); skins, colours, UV sets and morph targets \
follow. Everything else stays as it was. A primitive that gets no tangents is named with its reason; a file with \
nothing to do is copied.

Without -o, --out-dir or --in-place the output lies beside its input: model.glb becomes model.tangents.glb. The output's \
extension decides the container: .glb embeds everything, .gltf writes its buffer beside it and brings images along.

Folders are searched for .gltf, .glb and .vrm, inner folders included. Names like model.tangents.glb are left out \
there, as they are outputs, and so is the folder of --out-dir; give such a file by name to use it.";

const TANGENTS_EXAMPLES: &str = "\
Examples:
  darboux tangents model.glb                        writes model.tangents.glb
  darboux tangents model.gltf -o model.glb          the same into one file
  darboux tangents models --out-dir out             a whole folder, its structure kept
  darboux tangents models --in-place --only-needed  only where materials use tangents
  darboux tangents a.glb --overwrite --json         replace old tangents, report as JSON
  curl -s URL | darboux tangents - > model.glb      from a pipe into a file";

/// `darboux tangents`.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("destination").args(["output", "out_dir", "in_place"]))]
pub struct TangentsArguments {
    /// Files (.gltf, .glb, .vrm) and folders; - is standard input
    #[arg(required = true, value_name = "INPUT")]
    pub inputs: Vec<PathBuf>,

    /// Output file for a single input; - is standard output, as GLB
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub output: Option<PathBuf>,

    /// Folder for all outputs; paths below input folders are kept
    #[arg(long, value_name = "FOLDER", help_heading = "Output")]
    pub out_dir: Option<PathBuf>,

    /// Replace each input by its output
    ///
    /// The new file is written beside the old one and renamed when it is complete. A file that needs no tangents is not
    /// touched.
    #[arg(long, help_heading = "Output")]
    pub in_place: bool,

    /// Replace output files that exist
    #[arg(long, help_heading = "Output")]
    pub force: bool,

    /// Which defects of the MikkTSpace reference to keep
    #[arg(long, value_enum, default_value_t, help_heading = "Tangents")]
    pub mode: Mode,

    /// Split tangents of faces whose directions differ by this many degrees or more
    ///
    /// Bakers use 180: tangents are split only where they must be.
    #[arg(
        long,
        value_name = "DEGREES",
        default_value_t = 180.0,
        value_parser = finite,
        allow_negative_numbers = true,
        help_heading = "Tangents"
    )]
    pub threshold: f32,

    /// Replace tangents that exist; without it such primitives are kept
    #[arg(long, help_heading = "Tangents")]
    pub overwrite: bool,

    /// Only primitives whose material uses tangents (normal map, clearcoat normal map, anisotropy)
    #[arg(long, help_heading = "Tangents")]
    pub only_needed: bool,

    /// Apply KHR_texture_transform to the UVs first
    ///
    /// The specification asks for tangents of the UVs as stored, which is the default. Some renderers expect tangents of
    /// the transformed UVs; the two differ where a transform rotates or mirrors, and then a warning says so.
    #[arg(long, help_heading = "Tangents")]
    pub apply_texture_transform: bool,

    /// Refuse files with non-finite vertex data or corners that have no usable tangent
    #[arg(long, help_heading = "Input")]
    pub strict: bool,

    /// Allow buffers and images outside the input's folder
    #[arg(long, help_heading = "Input")]
    pub allow_outside: bool,

    /// Write a report as JSON to standard output
    #[arg(long, help_heading = "Messages")]
    pub json: bool,

    /// Print errors only
    #[arg(short, long, help_heading = "Messages")]
    pub quiet: bool,
}

/// `--mode`: [`darboux::Mode`] as people type it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Mode {
    /// Every bit of the reference, zero-length and non-finite tangents included
    Reference,
    /// The reference's bits where they are usable, a unit tangent elsewhere
    #[default]
    Repaired,
    /// As repaired, with all edges matched and one sign per triangle
    Corrected,
}

impl From<Mode> for darboux::Mode {
    fn from(mode: Mode) -> Self {
        match mode {
            Mode::Reference => Self::Reference,
            Mode::Repaired => Self::Repaired,
            Mode::Corrected => Self::Corrected,
        }
    }
}

const INSPECT_ABOUT: &str = "\
Show what each primitive holds and what its tangents would meet.

One line per primitive: vertices, triangles, attributes, the UV set that tangents belong to, vertices that must be split, \
edges where the UVs mirror, degenerate triangles (in space and in UVs), and whether it has tangents. Nothing is written.";

const INSPECT_EXAMPLES: &str = "\
Examples:
  darboux inspect model.glb
  darboux inspect models/*.gltf
  darboux inspect model.glb --json | jq '.files[].primitives[] | select(.mirrored_edges > 0)'";

/// `darboux inspect`.
#[derive(Debug, Args)]
pub struct InspectArguments {
    /// Files (.gltf, .glb, .vrm) and folders; - is standard input
    #[arg(required = true, value_name = "FILE")]
    pub inputs: Vec<PathBuf>,

    /// Allow buffers and images outside the input's folder
    #[arg(long)]
    pub allow_outside: bool,

    /// Write the table as JSON
    #[arg(long)]
    pub json: bool,
}

fn finite(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(degrees) if degrees.is_finite() => Ok(degrees),
        _ => Err("not a number of degrees".into()),
    }
}

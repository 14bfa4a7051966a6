//! The arguments of `darboux inspect`.

use std::path::PathBuf;

use clap::Args;

use crate::options::messages::MessageOptions;
use crate::options::reading::ReadOptions;

pub const ABOUT: &str = "\
Show what each primitive holds and what its tangents would meet.

One line per primitive: vertices, triangles, attributes, the UV set that tangents belong to, vertices that must be split, \
edges where the UVs mirror, degenerate triangles (in space and in UVs), and whether it has tangents. Nothing is written.";

pub const EXAMPLES: &str = "\
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

    #[command(flatten)]
    pub reading: ReadOptions,

    #[command(flatten)]
    pub messages: MessageOptions,
}

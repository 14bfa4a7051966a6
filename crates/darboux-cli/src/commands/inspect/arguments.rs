//! The arguments of `darboux inspect`.

use std::path::PathBuf;

use clap::Args;

use crate::options::formats::with_endings;
use crate::options::messages::MessageOptions;
use crate::options::reading::ReadOptions;

pub const ABOUT: &str = "\
Show the contents of each primitive and the difficulties for its tangents. No file is written.

For each primitive: the number of vertices and triangles, the UV set that its tangents follow, the edges \
between mirrored and unmirrored UVs, degenerate triangles (of positions, and of UVs alone), the vertices \
that tangents would split, whether it has tangents, its attributes, and which method made its tangents. \
In the column of tangents, `needed` means that the material uses tangents and the file has none.";

pub const EXAMPLES: &str = "\
Examples:
  darboux inspect model.glb
  darboux inspect models/*.gltf
  darboux inspect model.glb --json | jq '.files[].primitives[] | select(.mirrored_edges > 0)'";

/// Which files are inspected.
#[derive(Debug, Args)]
pub struct InspectArguments {
    #[arg(required = true, value_name = "FILE", help = with_endings("Files ({models}) and folders of them; - \
         is standard input"))]
    pub inputs: Vec<PathBuf>,

    #[command(flatten)]
    pub reading: ReadOptions,

    #[command(flatten)]
    pub messages: MessageOptions,
}

//! The arguments of `darboux view`.

use std::path::PathBuf;

use clap::Args;

use crate::options::formats::with_endings;
use crate::options::reading::ReadOptions;

pub const ABOUT: &str = "\
Show a model in the browser: its normal map lit with the tangents of two sources side by side, its frames, \
signs and seams, and what `darboux check` finds in it.

The page and the model are served on a random port of this machine, and only under the printed address, \
which contains a secret; nothing leaves the machine. Ctrl-C ends the viewer. Without a model the page shows \
a sample. Models can be dropped onto the page.

`cargo xtask dist-viewer` builds the page's files. The command looks for them in the folder `viewer` beside \
this program, then in the source folder of this program.";

pub const EXAMPLES: &str = "\
Examples:
  darboux view model.glb
  darboux view low.glb --high high.glb   bake the detail of high.glb in the page
  darboux view model.gltf --no-open      only print the address";

/// What is shown, and how.
#[derive(Debug, Args)]
pub struct ViewArguments {
    #[arg(value_name = "MODEL", help = with_endings("A model ({models})"))]
    pub model: Option<PathBuf>,

    /// A high-poly model whose detail the page bakes into a normal map of MODEL
    #[arg(long, value_name = "HIGH", requires = "model")]
    pub high: Option<PathBuf>,

    /// Print the address and open no browser
    #[arg(long)]
    pub no_open: bool,

    #[command(flatten)]
    pub reading: ReadOptions,

    /// The folder with the page's files
    #[arg(long, value_name = "FOLDER")]
    pub page: Option<PathBuf>,
}

//! The arguments of `darboux view`.

use std::path::PathBuf;

use clap::Args;

use crate::options::reading::ReadOptions;

pub const ABOUT: &str = "\
Show a model in the browser: normal-mapped, split between two sources of tangents, with its frames, signs, seams and a report.

The page and the model are served to this machine alone, at a random port, to whoever knows the address that is printed; nothing leaves \
the machine. Ctrl-C ends it. Without a model the page opens with a sample, and takes models that are dropped onto it.

The page's files are made by `cargo xtask dist-viewer`; they are looked for in the folder viewer beside this program, then where it was \
built.";

pub const EXAMPLES: &str = "\
Examples:
  darboux view model.glb
  darboux view model.gltf --no-open   print the address only, for a browser of your choice";

/// `darboux view`.
#[derive(Debug, Args)]
pub struct ViewArguments {
    /// A model: .gltf, .glb, .vrm or .obj
    #[arg(value_name = "MODEL")]
    pub model: Option<PathBuf>,

    /// Print the address and open no browser
    #[arg(long)]
    pub no_open: bool,

    #[command(flatten)]
    pub reading: ReadOptions,

    /// The folder with the page's files
    #[arg(long, value_name = "FOLDER")]
    pub page: Option<PathBuf>,
}

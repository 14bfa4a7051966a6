//! The arguments of `darboux devices`.

use clap::Args;

pub const ABOUT: &str = "\
List the graphics adapters that `darboux tangents --device gpu` can use, including software adapters.

`darboux tangents` uses the adapter that the system ranks as the fastest. The largest buffer that shaders \
can access limits the number of triangles per dispatch; larger meshes are processed in parts.";

/// The format of the list.
#[derive(Debug, Args)]
pub struct DevicesArguments {
    /// Print a JSON report to standard output
    #[arg(long)]
    pub json: bool,
}

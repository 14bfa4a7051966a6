//! The arguments of `darboux devices`.

use clap::Args;

pub const ABOUT: &str = "\
List the adapters that `darboux tangents --device gpu` can use, software ones included.

That command takes the one which the system calls the fastest. By the largest buffer that its shaders can reach, an adapter computes a \
number of triangles at once; larger meshes are cut into pieces.";

/// `darboux devices`.
#[derive(Debug, Args)]
pub struct DevicesArguments {
    /// Print a JSON report to standard output
    #[arg(long)]
    pub json: bool,
}

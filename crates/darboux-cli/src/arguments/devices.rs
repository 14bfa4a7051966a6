//! `darboux devices`.

use clap::Args;

pub(super) const ABOUT: &str = "\
List the adapters that `darboux tangents --device gpu` can use, software ones included.

That command takes the one which the system calls the fastest. An adapter computes meshes up to a number of triangles, by the largest \
buffer that its shaders can reach; larger ones are for the CPU.";

/// `darboux devices`.
#[derive(Debug, Args)]
pub struct DevicesArguments {
    /// Print a JSON report to standard output
    #[arg(long)]
    pub json: bool,
}

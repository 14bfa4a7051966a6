//! `--json` and `--quiet`.

use clap::Args;

/// What a command prints.
#[derive(Debug, Args)]
pub struct MessageOptions {
    /// Write a report as JSON to standard output
    #[arg(long, help_heading = "Messages")]
    pub json: bool,

    /// Print errors only
    #[arg(short, long, help_heading = "Messages")]
    pub quiet: bool,
}

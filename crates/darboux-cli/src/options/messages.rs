//! `--json` and `--quiet`.

use clap::Args;

/// What a command prints.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct MessageOptions {
    /// Write a report as JSON to standard output
    #[arg(long, help_heading = "Messages")]
    pub json: bool,

    /// Print errors only; commands that write files also print one line with the totals
    #[arg(short, long, help_heading = "Messages")]
    pub quiet: bool,
}

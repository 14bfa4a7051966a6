//! Stand-ins for the subcommands and options that this build lacks: each names the command line that installs
//! them.

use std::ffi::OsString;

use clap::Args;

use crate::exit;
use crate::installing::install_with;
use crate::terminal::Messages;

/// The sentence about a part of the command that this build lacks.
pub fn missing_feature(part: &str, feature: &str) -> String {
    format!("{part} is not in this build of darboux; install it with `{}`", install_with(feature))
}

/// Accepts any arguments, so that the only message is the one about the missing subcommand.
#[derive(Debug, Args)]
#[command(disable_help_flag = true)]
pub struct MissingArguments {
    #[arg(allow_hyphen_values = true, trailing_var_arg = true, num_args = 0.., hide = true)]
    arguments: Vec<OsString>,
}

/// Prints how to install the subcommand and returns the exit code.
pub fn run(subcommand: &str, feature: &str) -> u8 {
    Messages::new(false).error(&missing_feature(&format!("`darboux {subcommand}`"), feature));
    exit::USAGE
}

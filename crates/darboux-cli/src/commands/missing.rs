//! Stand-ins for the subcommands and options that this build lacks: each names the command line that installs them.

use std::ffi::OsString;

use clap::Args;

use crate::exit;
use crate::terminal::Messages;

/// The sentence about a part of the command that this build lacks.
pub fn missing_feature(part: &str, feature: &str) -> String {
    let package = package(env!("CARGO_MANIFEST_DIR"));
    format!(
        "{part} is not in this build of darboux; install it with `cargo install {package} --features {feature}`"
    )
}

/// What `cargo install` is told to build. `folder`: where the sources of this build were. The folder of a package from a registry ends with its
/// version; cargo keeps what `cargo install --git` builds in a folder of its own, of which a user knows only the address.
fn package(folder: &str) -> &'static str {
    let is_checkout = folder.ends_with("darboux-cli");
    let is_of_git = folder.contains("/git/checkouts/") || folder.contains(r"\git\checkouts\");
    match (is_checkout, is_of_git) {
        (true, true) => "--git ADDRESS darboux-cli",
        (true, false) => "--path crates/darboux-cli",
        (false, _) => "darboux-cli",
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_installs_from_where_this_build_came() {
        assert_eq!(package("/home/a/darboux/crates/darboux-cli"), "--path crates/darboux-cli");
        assert_eq!(package(r"C:\darboux\crates\darboux-cli"), "--path crates/darboux-cli");
        assert_eq!(
            package("/home/a/.cargo/registry/src/index.crates.io-1949cf8c6b5b557f/darboux-cli-0.1.0"),
            "darboux-cli"
        );
        assert_eq!(
            package("/home/a/.cargo/git/checkouts/darboux-5af0e1/2f1aa36/crates/darboux-cli"),
            "--git ADDRESS darboux-cli"
        );
    }
}

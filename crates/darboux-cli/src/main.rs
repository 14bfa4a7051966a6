//! The `darboux` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(darboux_cli::run(std::env::args_os()))
}

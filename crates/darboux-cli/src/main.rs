//! The `darboux` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    darboux_cli::silence_panics();
    ExitCode::from(darboux_cli::run(std::env::args_os()))
}

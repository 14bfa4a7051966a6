//! The `darboux` command.

use std::process::ExitCode;

/// Missing memory is one sentence, not SIGABRT.
#[cfg(unix)]
#[global_allocator]
static ALLOCATOR: darboux_cli::ExitWithoutMemory = darboux_cli::ExitWithoutMemory;

fn main() -> ExitCode {
    darboux_cli::silence_panics();
    ExitCode::from(darboux_cli::run(std::env::args_os()))
}

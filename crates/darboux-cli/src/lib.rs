//! The `darboux` command as a library: parse, call, print.

mod arguments;
mod inspect;
mod interrupt;
mod jobs;
mod messages;
mod models;
mod tangents;

use std::ffi::OsString;

use clap::Parser;

pub use arguments::Arguments;
use arguments::Command;

/// The exit code when all went well, nothing to do included.
const DONE: u8 = 0;
/// The exit code when an input is bad or a file failed.
const FAILED: u8 = 1;
/// The exit code of wrong usage.
const USAGE: u8 = 2;

/// Runs the command with the process's standard streams; the first argument is the program's name. Returns the exit code:
/// 0 done, 1 an input is bad or a file failed, 2 wrong usage.
pub fn run<I, A>(arguments: I) -> u8
where
    I: IntoIterator<Item = A>,
    A: Into<OsString> + Clone,
{
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            let _closed_is_no_fault = error.print();
            return if error.use_stderr() { USAGE } else { DONE };
        }
    };
    interrupt::wait_for_writes();
    match arguments.command {
        Command::Tangents(arguments) => tangents::run(&arguments),
        Command::Inspect(arguments) => inspect::run(&arguments),
    }
}

//! The `darboux` command as a library: parse, call, print.

mod arguments;
mod batch;
mod compare;
mod convert;
mod devices;
#[cfg_attr(not(feature = "gpu"), path = "without_gpu.rs")]
mod gpu;
mod inspect;
mod interrupt;
mod jobs;
mod journal;
mod library;
mod messages;
mod methods;
mod models;
mod normals;
#[cfg_attr(not(feature = "gpu"), path = "render_without_gpu.rs")]
mod render;
mod report;
mod tangents;
mod view;

use std::ffi::OsString;

use clap::Parser;

pub use arguments::Arguments;
use arguments::Command;
pub use library::{Library, carry_out, give_up};

/// Exit codes, as `darboux --help` lists them.
mod exit {
    pub const DONE: u8 = 0;
    pub const FAILED: u8 = 1;
    pub const USAGE: u8 = 2;
    pub const DIFFERENT: u8 = 3;
}

/// Runs the command on the process's standard streams and gives its exit code: 0 done, 1 an input is bad or a file failed,
/// 2 wrong usage, 3 compared files differ by more than asked for. The first argument is the program's name.
pub fn run<A>(arguments: impl IntoIterator<Item = A>) -> u8
where
    A: Into<OsString> + Clone,
{
    match Arguments::try_parse_from(arguments) {
        Ok(arguments) => match &arguments.command {
            Command::Tangents(arguments) => batch::run(arguments),
            Command::Normals(arguments) => batch::run(arguments),
            Command::Convert(arguments) => batch::run(arguments),
            Command::Compare(arguments) => compare::run(arguments),
            Command::Inspect(arguments) => inspect::run(arguments),
            Command::Render(arguments) => render::run(arguments),
            Command::View(arguments) => view::run(arguments),
            Command::Methods => methods::run(),
            Command::Devices(arguments) => devices::run(arguments),
        },
        Err(help_or_error) => {
            let _closed_is_no_fault = help_or_error.print();
            if help_or_error.use_stderr() { exit::USAGE } else { exit::DONE }
        }
    }
}

//! The `darboux` command as a library: it parses a command line, runs the subcommand and prints the results.

mod batch;
mod command_line;
mod commands;
mod documents;
mod exit;
#[cfg(feature = "bake")]
mod file_id;
mod gpu;
mod heat_scale;
mod html_page;
mod inputs;
mod installing;
mod interrupt;
mod json;
mod memory;
mod model_json;
mod net;
mod options;
#[cfg(unix)]
#[expect(unsafe_code, reason = "an allocator is unsafe to implement, and limits are read with the C library")]
mod out_of_memory;
mod paths;
mod regular_file;
mod terminal;
mod text;

use std::ffi::OsString;
use std::io::Write;

use clap::Parser;

pub use batch::distributed::{DistributedBatch, failed_task, run_task};
/// For examples/pages.rs, which writes the reference. Not part of the API, because it shows clap's
/// types.
#[doc(hidden)]
pub use command_line::Arguments;
use command_line::Command;
#[cfg(feature = "bake")]
pub use commands::bake::job::distributed::DistributedJob;
pub use net::silence_panics;
#[cfg(unix)]
pub use out_of_memory::ExitWithoutMemory;

/// Runs the command on the process's standard streams and returns its exit code.
///
/// The first argument is the program's name. Exit codes: 0 done, 1 an input is bad or a file failed, 2 wrong
/// usage, 3 the compared files differ by more than the tolerance.
pub fn run<A>(arguments: impl IntoIterator<Item = A>) -> u8
where
    A: Into<OsString> + Clone,
{
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    match Arguments::try_parse_from(&arguments) {
        Ok(arguments) => net::run(|| run_command(&arguments.command)),
        Err(error) if error.use_stderr() => {
            let text = text::with_printable_arguments(error.render().ansi().to_string(), &arguments);
            let _closed_stderr_is_ignored = write!(anstream::stderr(), "{text}");
            exit::USAGE
        }
        Err(help) => {
            let _closed_stdout_is_ignored = help.print();
            exit::DONE
        }
    }
}

fn run_command(command: &Command) -> u8 {
    // Both before threads reserve addresses that are no memory.
    #[cfg(unix)]
    out_of_memory::share_arena_where_addresses_are_limited();
    memory::of_process();
    match command {
        Command::Tangents(arguments) => batch::run(arguments),
        Command::Normals(arguments) => batch::run(arguments),
        Command::Convert(arguments) => batch::run(arguments),
        Command::Check(arguments) => commands::check::run(arguments),
        Command::Report(arguments) => commands::report::run(arguments),
        Command::Compare(arguments) => commands::compare::run(arguments),
        Command::Inspect(arguments) => commands::inspect::run(arguments),
        #[cfg(feature = "bake")]
        Command::Bake(arguments) => commands::bake::run(arguments),
        Command::Methods => commands::methods::run(),
        Command::Completions(arguments) => commands::completions::run(arguments),
        #[cfg(feature = "gpu")]
        Command::Render(arguments) => commands::render::run(arguments),
        #[cfg(feature = "view")]
        Command::View(arguments) => commands::view::run(arguments),
        #[cfg(feature = "gpu")]
        Command::Devices(arguments) => commands::devices::run(arguments),
        #[cfg(not(feature = "bake"))]
        Command::Bake(_) => commands::missing::run("bake", "full"),
        #[cfg(not(feature = "gpu"))]
        Command::Render(_) => commands::missing::run("render", "full"),
        #[cfg(not(feature = "view"))]
        Command::View(_) => commands::missing::run("view", "full"),
        #[cfg(not(feature = "gpu"))]
        Command::Devices(_) => commands::missing::run("devices", "full"),
    }
}

//! `darboux completions`: prints the completion script of a shell.

pub mod arguments;

use clap::{Command, CommandFactory};
use clap_complete::generate;
use darboux_io::system_reason;

use crate::command_line::Arguments;
use crate::exit;
use crate::terminal::{Messages, write_stdout};
use arguments::CompletionsArguments;

/// Runs the command and returns its exit code.
pub fn run(arguments: &CompletionsArguments) -> u8 {
    let mut script = Vec::new();
    generate(arguments.shell, &mut without_hidden(&Arguments::command()), "darboux", &mut script);
    match write_stdout(&script) {
        Ok(()) => exit::DONE,
        Err(error) => {
            Messages::new(false).error(&format!("the script cannot be written: {}", system_reason(&error)));
            exit::FAILED
        }
    }
}

/// The command without hidden subcommands, which stand for those that this build lacks.
fn without_hidden(whole: &Command) -> Command {
    let visible = whole.get_subcommands().filter(|subcommand| !subcommand.is_hide_set()).cloned();
    let about = whole.get_about().cloned().unwrap_or_default();
    Command::new("darboux").version(env!("CARGO_PKG_VERSION")).about(about).subcommands(visible)
}

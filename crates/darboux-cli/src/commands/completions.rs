//! `darboux completions`: prints the completion script of a shell.

pub mod arguments;

use clap::CommandFactory;
use clap_complete::generate;

use crate::command_line::Arguments;
use crate::exit;
use crate::terminal::{Messages, write_stdout};
use arguments::CompletionsArguments;

/// Runs the command and returns its exit code.
pub fn run(arguments: &CompletionsArguments) -> u8 {
    let mut script = Vec::new();
    generate(arguments.shell, &mut Arguments::command(), "darboux", &mut script);
    match write_stdout(&script) {
        Ok(()) => exit::DONE,
        Err(error) => {
            Messages::new(false).error(&format!("the script cannot be written: {error}"));
            exit::FAILED
        }
    }
}

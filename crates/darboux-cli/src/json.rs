//! JSON reports as text, and the version that they carry. json.txt documents their fields.

use std::io;

use darboux_io::system_reason;
use serde::Serialize;

use crate::exit;
use crate::terminal::{Messages, write_stdout};

/// The version of Darboux.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Serialises a report for standard output.
pub fn to_json(report: &impl Serialize) -> Result<Vec<u8>, serde_json::Error> {
    let mut text = serde_json::to_vec_pretty(report)?;
    text.push(b'\n');
    Ok(text)
}

/// Prints the report of a run that succeeded, if JSON is asked for. Returns the exit code.
pub fn print_report(report: &impl Serialize, json: bool, messages: &Messages) -> u8 {
    if !json {
        return exit::DONE;
    }
    match to_json(report).map_err(io::Error::from).and_then(|text| write_stdout(&text)) {
        Ok(()) => exit::DONE,
        Err(error) => {
            messages.error(&format!("the report cannot be written: {}", system_reason(&error)));
            exit::FAILED
        }
    }
}

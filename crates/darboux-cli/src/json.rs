//! JSON reports as text, and the version that they carry. json.txt documents their fields.

use serde::Serialize;

#[cfg(any(feature = "bake", feature = "gpu"))]
use crate::terminal::Messages;

/// The version of Darboux.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Serialises a report for standard output.
pub fn to_json(report: &impl Serialize) -> Result<Vec<u8>, serde_json::Error> {
    let mut text = serde_json::to_vec_pretty(report)?;
    text.push(b'\n');
    Ok(text)
}

/// Prints the report of a bake or a picture that succeeded, if JSON is asked for. Returns the exit code.
#[cfg(any(feature = "bake", feature = "gpu"))]
pub fn print_report(report: &impl Serialize, json: bool, messages: &Messages) -> u8 {
    use crate::exit;
    use crate::terminal::write_stdout;

    if !json {
        return exit::DONE;
    }
    match to_json(report).map_err(std::io::Error::from).and_then(|text| write_stdout(&text)) {
        Ok(()) => exit::DONE,
        Err(error) => {
            messages.error(&format!("the report cannot be written: {}", darboux_io::system_reason(&error)));
            exit::FAILED
        }
    }
}

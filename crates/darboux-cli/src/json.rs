//! JSON reports as text, and the version that they carry. json.md documents their fields.

use serde::Serialize;

/// The version of Darboux.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Serialises a report for standard output.
pub fn to_json(report: &impl Serialize) -> Result<Vec<u8>, serde_json::Error> {
    let mut text = serde_json::to_vec_pretty(report)?;
    text.push(b'\n');
    Ok(text)
}

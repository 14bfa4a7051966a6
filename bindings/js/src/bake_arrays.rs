//! Inputs and outputs that only the functions of `darboux/bake` have.

use darboux_bake::Images;
use serde::Serialize;

/// The inputs and results of these functions.
#[derive(Default)]
pub struct BakeArrays {
    /// The files: the low model, then the high ones.
    pub files: Vec<Vec<u8>>,
    /// The options, as JSON.
    pub options: Vec<u8>,
    /// The report, as JSON.
    pub json: String,
    pub images: Images,
    /// One per texel, as numbers.
    pub states: Vec<u8>,
}

impl BakeArrays {
    /// Keeps a report as JSON. Returns its address.
    pub fn put_json(&mut self, report: &impl Serialize) -> *const u8 {
        self.json = serde_json::to_string(report).unwrap_or_default();
        self.json.as_ptr()
    }
}

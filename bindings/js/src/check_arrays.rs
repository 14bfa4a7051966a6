//! Inputs and outputs that only the functions of `darboux/check` have.

use serde::Serialize;

/// The inputs and results of these functions.
#[derive(Default)]
pub struct CheckArrays {
    /// The bytes of a file, or texels.
    pub bytes: Vec<u8>,
    /// Four floats per corner.
    pub tangents: Vec<f32>,
    /// The result, as JSON.
    pub json: String,
    /// The names of the codes that a repair is limited to, one per line; empty: all.
    pub codes_to_repair: Vec<u8>,
    /// The conventions and layouts of a conversion, one per line.
    pub conversion_text: Vec<u8>,
    /// The repaired or converted file; empty where nothing was repaired.
    pub repaired: Vec<u8>,
}

impl CheckArrays {
    /// Keeps a result as JSON. Returns its address.
    pub fn put_json(&mut self, result: &impl Serialize) -> *const u8 {
        self.json = serde_json::to_string(result).unwrap_or_default();
        self.json.as_ptr()
    }
}

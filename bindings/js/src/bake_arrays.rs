//! Inputs and outputs that only the functions of `darboux/bake` have.

use darboux_bake::Images;
use serde::Serialize;

/// The inputs and results of these functions.
#[derive(Default)]
pub struct BakeArrays {
    /// The files: the low model, then the high ones.
    pub files: Vec<Vec<u8>>,
    /// Of the low mesh: four floats per corner, or three per vertex.
    pub low_tangents: Option<Vec<f32>>,
    pub cage: Option<Vec<f32>>,
    /// Of the high mesh: three floats per vertex, or one number per corner.
    pub high_positions: Vec<f32>,
    pub high_normals: Option<Vec<f32>>,
    pub high_indices: Option<Vec<u32>>,
    /// The options, as JSON.
    pub options: Vec<u8>,
    /// The report, as JSON.
    pub json: String,
    pub images: Images,
    /// One per texel, as numbers.
    pub states: Vec<u8>,
}

impl BakeArrays {
    /// Frees the models of the call before.
    pub fn clear_models(&mut self) {
        let Self { options, json, images, states, .. } = std::mem::take(self);
        *self = Self { options, json, images, states, ..Self::default() };
    }

    /// Keeps a report as JSON. Returns its address.
    pub fn put_json(&mut self, report: &impl Serialize) -> *const u8 {
        self.json = serde_json::to_string(report).unwrap_or_default();
        self.json.as_ptr()
    }
}

//! Inputs and outputs that only the functions of `darboux/bake` have.

use darboux::{Channel, TexelLayout};
use darboux_bake::Images;
use serde::Serialize;

use crate::prepared_models::PreparedModels;

/// The inputs and results of these functions.
#[derive(Default)]
pub struct BakeArrays {
    /// The files: the low model, then the high ones.
    pub files: Vec<Vec<u8>>,
    /// Models that are kept from call to call.
    pub prepared: Option<PreparedModels>,
    /// Of the low mesh: four floats per corner, or three per vertex.
    pub low_tangents: Option<Vec<f32>>,
    pub cage: Option<Vec<f32>>,
    /// Of the high mesh: three floats per vertex, or one number per corner.
    pub high_positions: Vec<f32>,
    pub high_normals: Option<Vec<f32>>,
    pub high_indices: Option<Vec<u32>>,
    /// The map of a bake that is verified, three floats per texel, and its states.
    pub given_normals: Vec<f32>,
    pub given_states: Vec<u8>,
    /// The map as a file has it.
    pub given_map: GivenMap,
    /// The options, as JSON.
    pub options: Vec<u8>,
    /// The report, as JSON.
    pub json: String,
    pub images: Images,
    /// One per texel, as numbers.
    pub states: Vec<u8>,
    /// The errors of a verification, one per texel.
    pub heat: Vec<f32>,
    /// The result of a conversion.
    pub converted: Vec<[f32; 3]>,
}

/// A normal map: three components per texel, as floats or as codes; none without floats.
pub enum GivenMap {
    Floats(Vec<f32>),
    Bytes(Vec<u8>),
    Words(Vec<u16>),
}

impl Default for GivenMap {
    fn default() -> Self {
        Self::Floats(Vec::new())
    }
}

impl GivenMap {
    /// The vectors of all texels.
    pub fn vectors(&self) -> Vec<[f32; 3]> {
        match self {
            Self::Floats(floats) => floats.as_chunks().0.to_vec(),
            Self::Bytes(codes) => decoded(codes),
            Self::Words(codes) => decoded(codes),
        }
    }
}

fn decoded<C: Channel>(codes: &[C]) -> Vec<[f32; 3]> {
    codes.as_chunks::<3>().0.iter().map(|&texel| TexelLayout::RGB.vector(texel)).collect()
}

impl BakeArrays {
    /// Frees the models of the call before.
    pub fn clear_models(&mut self) {
        let Self { prepared, options, json, images, states, .. } = std::mem::take(self);
        *self = Self { prepared, options, json, images, states, ..Self::default() };
    }

    /// Keeps a report as JSON. Returns its address.
    pub fn put_json(&mut self, report: &impl Serialize) -> *const u8 {
        self.json = serde_json::to_string(report).unwrap_or_default();
        self.json.as_ptr()
    }
}

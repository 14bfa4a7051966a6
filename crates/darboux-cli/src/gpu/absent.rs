//! The stand-in for builds without the feature `gpu`: no adapter exists.

use std::sync::atomic::AtomicBool;

use darboux::{Mesh, TangentOptions, Tangents};

use super::adapter::Adapter;

/// Why no adapter is listed.
pub const NO_ADAPTERS: &str = "this darboux was built without GPUs";

/// A GPU, which no value of this type can represent.
pub struct OpenGpu {
    pub name: String,
    pub is_software_unreported: AtomicBool,
    never: std::convert::Infallible,
}

/// Always fails.
pub fn open() -> Result<&'static OpenGpu, String> {
    Err(format!("{NO_ADAPTERS}: leave --device gpu out, or build with the feature gpu"))
}

impl OpenGpu {
    /// Never called.
    pub fn generate(&self, _: &Mesh<'_>, _: &TangentOptions, _: &mut Tangents) -> Result<usize, String> {
        match self.never {}
    }
}

/// Returns an empty list.
pub fn adapters() -> Vec<Adapter> {
    Vec::new()
}

//! In place of gpu.rs: a build that knows no GPU.

use darboux::{Mesh, TangentOptions, Tangents};

use crate::devices::Adapter;

/// Nothing that could be opened.
pub struct Opened {
    pub name: String,
    never: std::convert::Infallible,
}

/// Errors: always.
pub fn open() -> Result<&'static Opened, String> {
    Err("this darboux was built without GPUs: leave --device gpu out, or build with the feature gpu".into())
}

impl Opened {
    /// Never called.
    pub fn generate(&self, _: &Mesh<'_>, _: &TangentOptions, _: &mut Tangents) -> Result<usize, String> {
        match self.never {}
    }
}

/// None.
pub fn adapters() -> Vec<Adapter> {
    Vec::new()
}

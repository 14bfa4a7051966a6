//! In place of gpu.rs: a build that knows no GPU.

use std::sync::atomic::AtomicBool;

use darboux::{Mesh, TangentOptions, Tangents};

use crate::devices::Adapter;

/// Why no adapter is listed.
pub const NO_ADAPTERS: &str = "this darboux was built without GPUs";

/// Nothing that could be opened.
pub struct Opened {
    pub name: String,
    pub is_secretly_software: AtomicBool,
    never: std::convert::Infallible,
}

/// Errors: always.
pub fn open() -> Result<&'static Opened, String> {
    Err(format!("{NO_ADAPTERS}: leave --device gpu out, or build with the feature gpu"))
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

//! The stand-in for builds without the feature `gpu`: opening a GPU fails.

use std::sync::atomic::AtomicBool;

use darboux::{Mesh, TangentOptions, Tangents};

use crate::commands::missing::missing_feature;

/// A GPU; no value of this type exists.
pub struct OpenGpu {
    pub name: String,
    pub is_software_unreported: AtomicBool,
    never: std::convert::Infallible,
}

/// Fails with the command line that installs GPU support.
pub fn open() -> Result<&'static OpenGpu, String> {
    Err(missing_feature("--device gpu", "full"))
}

/// Fails with the command line that installs GPU support.
pub fn open_early() -> Result<(), String> {
    open().map(drop)
}

impl OpenGpu {
    /// Cannot be called.
    pub fn generate(&self, _: &Mesh<'_>, _: &TangentOptions, _: &mut Tangents) -> Result<usize, String> {
        match self.never {}
    }
}

//! The GPU of builds without the feature `gpu`: opening it fails, so no value of its type exists.

use darboux::{Context, Mesh, TangentOptions, Tangents};

use crate::commands::missing::missing_feature;

/// As the `OpenGpu` of builds with the feature `gpu`.
pub enum OpenGpu {}

/// Fails with the command line that installs GPU support.
pub fn open() -> Result<&'static OpenGpu, String> {
    Err(missing_feature("--device gpu", "full"))
}

/// Fails as [`open`].
pub fn open_early() -> Result<(), String> {
    open().map(drop)
}

impl OpenGpu {
    pub fn name(&self) -> &str {
        match *self {}
    }

    pub fn take_software_warning(&self) -> Option<String> {
        match *self {}
    }

    pub fn generate(
        &self,
        _: &Mesh<'_>,
        _: &TangentOptions,
        _: &mut Context,
        _: &mut Tangents,
    ) -> Result<usize, String> {
        match *self {}
    }
}

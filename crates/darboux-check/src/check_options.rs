//! [`CheckOptions`]: what is checked.

use darboux::BitangentDirection;

/// What is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct CheckOptions {
    /// Where the green of normal maps should point. Default: up, as glTF and OpenGL want it.
    pub green: BitangentDirection,
    /// Whether the images of normal maps are decoded and judged. Default: true.
    pub maps: bool,
}

impl Default for CheckOptions {
    fn default() -> Self {
        Self { green: BitangentDirection::Up, maps: true }
    }
}

impl CheckOptions {
    /// These options with another direction of green.
    #[must_use]
    pub fn with_green(self, green: BitangentDirection) -> Self {
        Self { green, ..self }
    }

    /// These options with or without maps.
    #[must_use]
    pub fn with_maps(self, maps: bool) -> Self {
        Self { maps, ..self }
    }
}

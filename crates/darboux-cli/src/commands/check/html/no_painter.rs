//! The stand-in for the painter in builds without the feature `gpu`.

use super::super::checks::Checks;
use super::pictures::Pictures;
use crate::commands::missing::missing_feature;
use crate::inputs::Input;

/// Draws nothing.
pub struct Painter;

impl Painter {
    pub fn open(_: &Checks<'_>) -> Self {
        Self
    }

    /// Says what draws pictures.
    pub fn draw(&self, _: &Input) -> Pictures {
        Pictures::None(Some(format!("{}.", missing_feature("The renderer of pictures", "full"))))
    }
}

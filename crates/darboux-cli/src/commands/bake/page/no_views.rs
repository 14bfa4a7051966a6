//! The stand-in for the pictures of models in builds without the feature `gpu`.

use darboux_io::gltf::Document;

use super::shared::View;
use crate::commands::bake::arguments::BakeArguments;
use crate::commands::missing::missing_feature;

/// Says what draws pictures.
pub fn draw(_: &BakeArguments, _: &Document, _: u64) -> Result<Vec<View>, String> {
    Err(missing_feature("The renderer of pictures", "full"))
}

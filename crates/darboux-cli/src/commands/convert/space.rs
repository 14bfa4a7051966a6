//! `--space`: normal maps between object space and tangent space.

use darboux::Context;
use darboux_bake::{LowModel, LowModelOptions, NormalSpace, SpaceOptions, convert_space};
use darboux_io::image::{PngImage, normal_vectors, set_normal_vectors};

use super::arguments::{ConvertArguments, SpaceChoice};
use super::{SpaceSummary, space_name};
use crate::documents::load_with_warnings;

impl ConvertArguments {
    /// Converts the vectors of an image to a space, with the frames of `--model`. Errors are one sentence
    /// each.
    pub(super) fn convert_space(
        &self,
        image: &mut PngImage,
        to: SpaceChoice,
        warnings: &mut Vec<String>,
    ) -> Result<SpaceSummary, String> {
        let sentence = |error: darboux_io::Error| error.to_string();
        let path = self.model.as_ref().ok_or("--space needs --model")?;
        let document = load_with_warnings(path, &self.files.reading, warnings)?;
        let corners = document.corners().map_err(sentence)?;
        let options = LowModelOptions::default().with_uv_set(self.uv_set);
        let low = LowModel::read(&document, &corners, &options).map_err(sentence)?;
        let surfaces = low.surfaces().map_err(sentence)?;
        let texels = normal_vectors(image, self.layout).map_err(sentence)?;
        let space = match to {
            SpaceChoice::Tangent => NormalSpace::Tangent,
            SpaceChoice::Object => NormalSpace::Object,
        };
        let [from, to_convention] = self.conventions().map(|named| named.convention);
        let options = SpaceOptions::new(image.size(), space).with_conventions(from, to_convention);
        let converted = convert_space(&surfaces, &texels, &options, &mut Context::new());
        let converted = converted.map_err(|error| format!("{}: {error}", path.display()))?;
        set_normal_vectors(image, self.layout, &converted.texels).map_err(sentence)?;
        if converted.charted_texels == 0 {
            warnings.push(format!("no triangle of {} covers a texel; check its UVs", path.display()));
        }
        Ok(SpaceSummary {
            to: space_name(to),
            charted_texels: converted.charted_texels,
            overlapping_texels: converted.overlapping_texels,
            invalid_texels: converted.invalid_texels,
        })
    }
}

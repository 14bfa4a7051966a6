//! `--model`: the model whose normal maps the images are.

use darboux_check::{
    CheckOptions, CheckedMap, FixOptions, FixedMap, ModelOfMaps, check_map, check_map_on_model,
    check_model_of_maps, fix_map, fix_map_on_model,
};
use darboux_io::LoadOptions;

use super::arguments::CheckArguments;
use crate::documents::load;
use crate::inputs::{Input, UsageError};
use crate::paths::is_image;

/// The model that images are checked on: its findings, or why it cannot be read; none without `--model`.
pub struct Model(Option<Result<ModelOfMaps, String>>);

impl Model {
    /// No model: images are checked alone.
    pub fn none() -> Self {
        Self(None)
    }

    /// Reads and checks the model once for all images. Errors: an input is no image.
    pub fn of(arguments: &CheckArguments, inputs: &[&Input]) -> Result<Self, UsageError> {
        let Some(model) = &arguments.model else { return Ok(Self::none()) };
        let may_be_image = |input: &Input| match input {
            Input::File(path) => is_image(path),
            Input::Stdin => true,
        };
        if let Some(other) = inputs.iter().find(|input| !may_be_image(input)) {
            return Err(UsageError(format!(
                "--model names the model of normal maps, and {other} is no image (.png, .jpg, .webp, .tga); \
                 check models without it"
            )));
        }
        let document = load(&Input::File(model.clone()), &arguments.files.reading);
        let check = |document| check_model_of_maps(&document).map_err(|error| error.to_string());
        Ok(Self(Some(document.and_then(check))))
    }

    /// Checks a normal map, on the model where there is one.
    pub fn check_image(&self, file: &[u8], options: &CheckOptions) -> Result<CheckedMap, String> {
        match &self.0 {
            None => Ok(check_map(file, options)),
            Some(Ok(on_model)) => Ok(check_map_on_model(file, on_model, options)),
            Some(Err(sentence)) => Err(sentence.clone()),
        }
    }

    /// Repairs a normal map, by what the texels and the model say together.
    pub fn fix_image(
        &self,
        name: &str,
        file: &[u8],
        loading: &LoadOptions,
        options: &FixOptions,
    ) -> Result<FixedMap, String> {
        match &self.0 {
            None => fix_map(name, file, loading, options),
            Some(Ok(on_model)) => fix_map_on_model(name, file, on_model, loading, options),
            Some(Err(sentence)) => return Err(sentence.clone()),
        }
        .map_err(|error| error.to_string())
    }
}

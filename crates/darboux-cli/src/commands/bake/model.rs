//! `--write-model`: the low model with the map in its materials and the tangents in its vertices; `--heat-model`: painted with errors.

use std::path::Path;

use darboux_bake::LowModel;
use darboux_io::gltf::{AddTangentsOptions, add_tangents};
use darboux_io::image::PngImage;
use darboux_io::{Outputs, SaveOptions};

use super::arguments::BakeArguments;
use super::open::open_low;

/// Refuses, before the bake, a model whose tangents `--write-model` cannot write. The error is one sentence.
pub fn refuse_model(arguments: &BakeArguments, low: &LowModel<'_>) -> Result<(), String> {
    let has_both = low.with_own_tangents > 0 && low.with_unused_tangents > 0;
    if arguments.write_model.is_some() && has_both {
        return Err(format!(
            "{}: some primitives were baked with their own tangents and others with computed ones; add --method, which computes all",
            arguments.low.display()
        ));
    }
    Ok(())
}

/// Stages the model and returns its path; none if it was not asked for. Errors are one sentence each.
///
/// The model is read again, because the bake still borrows the first one.
pub fn stage_model(
    arguments: &BakeArguments,
    low: &LowModel<'_>,
    map: Option<&PngImage>,
    warnings: &mut Vec<String>,
    outputs: &mut Outputs,
) -> Result<Option<String>, String> {
    let (Some(path), Some(map)) = (&arguments.write_model, map) else { return Ok(None) };
    let sentence = |error: darboux_io::Error| error.to_string();
    let mut document = open_low(arguments, &mut Vec::new())?;
    let name = path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let primitives: Vec<_> = low.primitives().map(|(name, uv_set)| (name.clone(), uv_set)).collect();
    document.set_normal_map(map.to_bytes().map_err(sentence)?, &name, &primitives).map_err(sentence)?;
    let options = AddTangentsOptions::default().with_overwrite(low.with_unused_tangents > 0);
    let options = match arguments.method {
        Some(method) => options.with_tangents(method.into()),
        None => options,
    };
    let tangents = add_tangents(&mut document, &options, &mut |_| {}).map_err(sentence)?;
    warnings.extend(tangents.warnings);
    let options = SaveOptions::default().with_force(arguments.force);
    document.stage(path, &options, outputs).map_err(sentence)?;
    Ok(Some(path.display().to_string()))
}

/// Stages the low model with a texture as its colour and without detail; returns the path. Errors are one sentence each.
pub fn stage_painted(
    arguments: &BakeArguments,
    low: &LowModel<'_>,
    texture: &PngImage,
    path: &Path,
    outputs: &mut Outputs,
) -> Result<String, String> {
    let sentence = |error: darboux_io::Error| error.to_string();
    let mut document = open_low(arguments, &mut Vec::new())?;
    let primitives: Vec<_> = low.primitives().map(|(name, uv_set)| (name.clone(), uv_set)).collect();
    let names: Vec<_> = primitives.iter().map(|(name, _)| name.clone()).collect();
    let flat = PngImage::from_rgb("flat", [1, 1], &[[128u8, 128, 255]]).and_then(|flat| flat.to_bytes());
    document.set_normal_map(flat.map_err(sentence)?, "flat", &primitives).map_err(sentence)?;
    document.paint(texture.to_bytes().map_err(sentence)?, "errors", &names).map_err(sentence)?;
    let options = SaveOptions::default().with_force(arguments.force);
    document.stage(path, &options, outputs).map_err(sentence)?;
    Ok(path.display().to_string())
}

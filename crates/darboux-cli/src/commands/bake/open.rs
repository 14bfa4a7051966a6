//! Reads the low model.

use darboux_bake::LowModel;
use darboux_io::gltf::{AddNormalsOptions, Document, add_normals};

use super::arguments::BakeArguments;
use crate::documents::load_with_warnings;

/// The low model, with generated normals where that was asked for.
pub fn open_low(arguments: &BakeArguments, warnings: &mut Vec<String>) -> Result<Document, String> {
    let mut document = load_with_warnings(&arguments.low, &arguments.reading, warnings)?;
    if let Some(options) = arguments.normals.options() {
        let options = AddNormalsOptions::default().with_normals(options);
        warnings.extend(add_normals(&mut document, &options, &mut |_| {}).map_err(sentence)?.warnings);
    }
    Ok(document)
}

/// The low model once more, to be edited while the bake borrows the first. Errors: a file whose surfaces are
/// no longer those that were baked.
pub fn reopen_low(arguments: &BakeArguments, low: &LowModel<'_>) -> Result<Document, String> {
    let document = open_low(arguments, &mut Vec::new())?;
    let corners = document.corners().map_err(sentence)?;
    let again = LowModel::read(&document, &corners, &arguments.low_options()).map_err(sentence)?;
    if !again.has_surfaces_of(low) {
        return Err(format!("{}: was changed while it was baked; bake it again", document.name()));
    }
    Ok(document)
}

fn sentence(error: darboux_io::Error) -> String {
    error.to_string()
}

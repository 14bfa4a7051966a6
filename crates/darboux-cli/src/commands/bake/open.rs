//! Reads the low and the high models.

use std::path::Path;

use darboux_io::gltf::{AddNormalsOptions, Document, add_normals};

use super::arguments::BakeArguments;
use crate::documents::load;
use crate::inputs::Input;

/// A high model. An OBJ becomes a document.
pub fn open_high(
    path: &Path,
    arguments: &BakeArguments,
    warnings: &mut Vec<String>,
) -> Result<Document, String> {
    let sentence = |error: darboux_io::Error| error.to_string();
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj")) {
        let model = darboux_io::obj::read(path, &arguments.reading.load_options()).map_err(sentence)?;
        warnings.extend(model.warnings);
        return Ok(model.document);
    }
    let mut document = load(&Input::File(path.to_owned()), &arguments.reading)?;
    document.decompress().map_err(sentence)?;
    warnings.extend(named_warnings(&document));
    Ok(document)
}

/// The low model, with generated normals where that was asked for.
pub fn open_low(arguments: &BakeArguments, warnings: &mut Vec<String>) -> Result<Document, String> {
    let sentence = |error: darboux_io::Error| error.to_string();
    let mut document = load(&Input::File(arguments.low.clone()), &arguments.reading)?;
    document.decompress().map_err(sentence)?;
    warnings.extend(named_warnings(&document));
    if let Some(options) = arguments.normals.options() {
        let options = AddNormalsOptions::default().with_normals(options);
        warnings.extend(add_normals(&mut document, &options, &mut |_| {}).map_err(sentence)?.warnings);
    }
    Ok(document)
}

/// The warnings of a document with its name, which tells several models apart.
fn named_warnings(document: &Document) -> impl Iterator<Item = String> {
    document.warnings().iter().map(|warning| format!("{}: {warning}", document.name()))
}

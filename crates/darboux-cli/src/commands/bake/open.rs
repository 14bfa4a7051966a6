//! Reads the low model.

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

fn sentence(error: darboux_io::Error) -> String {
    error.to_string()
}

//! Reads the low model, the high ones and the cage.

use std::path::Path;

use darboux_io::gltf::{AddNormalsOptions, Document, add_normals};

use super::arguments::BakeArguments;
use crate::documents::load;
use crate::inputs::Input;

/// A model, decompressed. An OBJ becomes a document. Warnings have the name of the file, which tells several models apart.
pub fn open(path: &Path, arguments: &BakeArguments, warnings: &mut Vec<String>) -> Result<Document, String> {
    let is_obj = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"));
    let (mut document, of_obj) = if is_obj {
        let model = darboux_io::obj::read(path, &arguments.reading.load_options()).map_err(sentence)?;
        (model.document, model.warnings)
    } else {
        (load(&Input::File(path.to_owned()), &arguments.reading)?, Vec::new())
    };
    document.decompress().map_err(sentence)?;
    let all = of_obj.iter().chain(document.warnings());
    warnings.extend(all.map(|warning| format!("{}: {warning}", document.name())));
    Ok(document)
}

/// The low model, with generated normals where that was asked for.
pub fn open_low(arguments: &BakeArguments, warnings: &mut Vec<String>) -> Result<Document, String> {
    let mut document = open(&arguments.low, arguments, warnings)?;
    if let Some(options) = arguments.normals.options() {
        let options = AddNormalsOptions::default().with_normals(options);
        warnings.extend(add_normals(&mut document, &options, &mut |_| {}).map_err(sentence)?.warnings);
    }
    Ok(document)
}

fn sentence(error: darboux_io::Error) -> String {
    error.to_string()
}

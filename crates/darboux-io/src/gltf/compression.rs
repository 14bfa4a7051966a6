//! Compressed meshes and buffer views become plain ones: decoded, and written without their extension.

mod draco;
mod meshopt;

use serde_json::value::RawValue;

use super::document::Document;
use super::json::{keys, member, set_member};
use crate::error::Fault;

/// Decodes what is compressed. The bytes that it was decoded from stay in their buffers, unused.
pub(super) fn decompress(document: &mut Document) -> Result<(), Fault> {
    meshopt::decompress(document)?;
    draco::decompress(document)
}

/// A JSON object without one of its extensions, and without `extensions` when that was the last.
fn without_extension(object: &str, names: &[&str]) -> serde_json::Result<String> {
    let Some(mut extensions) = member(object, "extensions")?.map(str::to_owned) else {
        return Ok(object.to_owned());
    };
    for name in names {
        extensions = set_member(&extensions, name, None)?;
    }
    let kept = (!keys(&extensions)?.is_empty()).then_some(extensions.as_str());
    set_member(object, "extensions", kept)
}

/// The JSON text of one element of a top-level array, as it was read.
fn element_text(document: &Document, array: &str, index: usize) -> serde_json::Result<String> {
    let elements: Vec<&RawValue> = serde_json::from_str(member(document.text(), array)?.unwrap_or("[]"))?;
    Ok(elements.get(index).map_or("{}", |element| element.get()).to_owned())
}

fn unreadable(error: serde_json::Error) -> Fault {
    Fault::invalid("", format!("the JSON cannot be edited: {error}; export the file again"))
}

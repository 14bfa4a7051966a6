//! `convertFile` of `darboux/check`: a model or a normal map in another convention.

use darboux::Convention;
use darboux_io::gltf::{Document, convert_vertices};
use darboux_io::image::{Channels, PngImage, convert_normal_map};
use serde::Serialize;

use crate::arena::with_arena;
use crate::inputs::resized;
use crate::reading::load_options;

/// Four lines: the source convention, the target convention, the channels of the vector in the source and in
/// the target.
#[unsafe(no_mangle)]
pub extern "C" fn conversion_text(bytes: usize) -> *mut u8 {
    with_arena(|arena| resized(&mut arena.check.conversion_text, bytes))
}

/// What became of the file.
#[derive(Serialize)]
enum Converted {
    #[serde(rename = "warnings")]
    Warnings(Vec<String>),
    #[serde(rename = "error")]
    Error(String),
}

/// Converts the file that `file_bytes` holds: a PNG image or a model. The new file lies where that of a
/// repair does (`repaired_file`). Returns the address of the JSON.
#[unsafe(no_mangle)]
pub extern "C" fn convert_file() -> *const u8 {
    with_arena(|arena| {
        let arrays = &mut arena.check;
        arrays.repaired.clear();
        let text = String::from_utf8_lossy(&arrays.conversion_text);
        let converted = match converted(&arrays.bytes, &text) {
            Ok((file, warnings)) => {
                arrays.repaired = file;
                Converted::Warnings(warnings)
            }
            Err(sentence) => Converted::Error(sentence),
        };
        arrays.put_json(&converted)
    })
}

/// The new file, and warnings. Errors: one sentence.
fn converted(file: &[u8], text: &str) -> Result<(Vec<u8>, Vec<String>), String> {
    let mut lines = text.split('\n');
    let mut line = || lines.next().unwrap_or_default();
    let (source, target) = (convention("source", line())?, convention("target", line())?);
    let (layout, to_layout) = (channels("layout", line())?, channels("toLayout", line())?);
    let sentence = |error: darboux_io::Error| error.to_string();
    let options = load_options();
    if PngImage::is_png(file) {
        let mut image = PngImage::from_bytes("the map", file.to_vec(), &options).map_err(sentence)?;
        convert_normal_map(&mut image, &source.to(target), layout, to_layout).map_err(sentence)?;
        return Ok((image.to_bytes().map_err(sentence)?, Vec::new()));
    }
    let mut document = Document::from_bytes("the model", file.to_vec(), None, &options).map_err(sentence)?;
    let mut warnings = document.warnings().to_vec();
    let summary = convert_vertices(&mut document, source, target, &mut |_| ()).map_err(sentence)?;
    warnings.extend(summary.warnings);
    if document.convention().map_err(sentence)? != Convention::GLTF {
        warnings
            .push(format!("the file is in the convention {target}: no viewer of glTF shows it correctly"));
    }
    Ok((document.to_glb().map_err(sentence)?, warnings))
}

fn convention(name: &str, text: &str) -> Result<Convention, String> {
    text.parse().map_err(|error| format!("{name}: {error}"))
}

fn channels(name: &str, text: &str) -> Result<Channels, String> {
    text.parse().map_err(|error| format!("{name}: {error}"))
}

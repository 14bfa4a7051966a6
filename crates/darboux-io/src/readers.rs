//! Chooses the reader of a format by the content of a file, and turns its scene into a document.

use crate::LoadOptions;
use crate::error::ContentError;
use crate::source::{self, Built, ModelFiles, SourceFormat, SourceScene};

/// Reads a file of another format than glTF as a GLB. None: the file is glTF. `name` is the file's name,
/// whose ending says what was meant where the content says nothing.
///
/// Errors: the file is broken; it is of a format without a reader, which the error names.
pub fn read(
    name: &str,
    bytes: &[u8],
    files: &ModelFiles,
    options: &LoadOptions,
) -> Option<Result<Built, ContentError>> {
    // Editors of Windows begin a text with a byte order mark, which belongs to no statement.
    let bytes = source::without_byte_order_mark(bytes);
    let first = bytes.iter().find(|byte| !byte.is_ascii_whitespace());
    if bytes.starts_with(b"glTF") || first == Some(&b'{') {
        return None;
    }
    let Some(format) = source::detect(bytes) else {
        return Some(Err(ContentError::invalid("", source::problem_of_other(bytes, name))));
    };
    let scene = scene(format, bytes, files, options);
    Some(scene.and_then(|scene| source::build(scene, bytes.len(), options)))
}

/// The scene of a file in a format.
fn scene(
    format: SourceFormat,
    bytes: &[u8],
    files: &ModelFiles,
    options: &LoadOptions,
) -> Result<SourceScene, ContentError> {
    match format {
        #[cfg(feature = "fbx")]
        SourceFormat::Fbx => crate::fbx::read(bytes, files, options),
        #[cfg(feature = "obj")]
        SourceFormat::Obj => crate::obj::read(bytes, files, options),
        #[cfg(feature = "ply")]
        SourceFormat::Ply => crate::ply::read(bytes, files),
        #[cfg(feature = "stl")]
        SourceFormat::Stl => crate::stl::read(bytes),
        SourceFormat::Usd => Err(ContentError::unsupported(
            "",
            "is USD, which is not read here; export the model as .glb, or compute its tangents with \
             darboux.usd in Python",
        )),
        #[allow(unreachable_patterns, reason = "with all readers, no format is left")]
        other => {
            _ = (bytes, files);
            let advice = options.option_names.missing_reader;
            let problem = format!("is {}, which this build does not read; {advice}", other.name());
            Err(ContentError::unsupported("", problem))
        }
    }
}

//! Questions about paths: their file kind, a canonical spelling to compare them by, and whether their folder
//! exists.

use std::path::{Path, PathBuf};

use darboux_io::FileKind;

/// Whether a path has the extension of a glTF model.
pub fn is_gltf(path: &Path) -> bool {
    FileKind::of(path).is_some_and(FileKind::is_gltf)
}

/// Whether a path has the extension of a model that can be written.
pub fn is_written_model(path: &Path) -> bool {
    FileKind::of(path).is_some_and(FileKind::is_written_model)
}

/// Whether the extension is .png.
pub fn is_png(path: &Path) -> bool {
    FileKind::of(path) == Some(FileKind::Png)
}

/// Whether a path has the extension of an image that can be decoded.
pub fn is_image(path: &Path) -> bool {
    FileKind::of(path).is_some_and(FileKind::is_decoded_image)
}

/// One spelling for all paths of a file, whether the file exists yet or not.
pub fn canonical(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    for ancestor in path.ancestors() {
        if let Ok(existing) = ancestor.canonicalize() {
            return match path.strip_prefix(ancestor) {
                Ok(rest) if rest != Path::new("") => existing.join(rest),
                _ => existing,
            };
        }
    }
    path
}

/// Refuses an output file whose folder does not exist: most likely its name is mistyped.
pub fn refuse_missing_folder(output: &Path) -> Result<(), String> {
    match output.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.exists()) {
        Some(folder) => Err(format!(
            "{}: the folder {} does not exist; create it, or choose another one",
            output.display(),
            folder.display()
        )),
        None => Ok(()),
    }
}

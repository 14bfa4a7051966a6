//! What to call for a folder that has images and no model.

use std::path::{Path, PathBuf};

use walkdir::WalkDir;

use crate::paths::is_image;
use crate::text::{command_line, counted};

/// Which command checks the normal maps of a folder, as a clause; none for a folder without images. A folder has colour textures, too, so images are
/// named one by one.
pub fn maps_instead(folder: &Path) -> Option<String> {
    let entries = WalkDir::new(folder).sort_by_file_name().into_iter().filter_map(Result::ok);
    let files = entries.filter(|entry| entry.file_type().is_file()).map(walkdir::DirEntry::into_path);
    let images: Vec<PathBuf> = files.filter(|path| is_image(path)).collect();
    let first = images.iter().find(|path| is_named_like_normals(path)).or(images.first())?;
    let name = first.display().to_string();
    let command = command_line(&["check"], &[&name]);
    let images = counted(images.len(), "image", "images");
    Some(format!("it has {images} (.png, .jpg, .webp): name those that are normal maps, as in `{command}`"))
}

/// Whether a file name looks like that of a normal map.
fn is_named_like_normals(path: &Path) -> bool {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    ["normal", "nrm", "_nor", "_n"]
        .iter()
        .any(|part| name.contains(part) && (*part != "_n" || name.ends_with("_n")))
}

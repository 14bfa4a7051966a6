//! What to call for images of a folder that are not checked: all where it has no model, and those that none
//! of its models uses.

use std::fs::File;
use std::io::{Read, Seek};
use std::path::{Path, PathBuf};

use darboux_io::FileKind;
use darboux_io::obj::companions;
use walkdir::WalkDir;

use crate::model_json::ModelJson;
use crate::paths::is_image;
use crate::regular_file::{Links, open_regular};
use crate::text::{command_line, counted};

/// Which command checks the normal maps of a folder, as a clause; none for a folder without images. A folder
/// has colour textures, too, so images are named one by one.
pub fn maps_instead(folder: &Path) -> Option<String> {
    let images = images(folder);
    let first = images.iter().find(|path| is_named_like_normals(path)).or(images.first())?;
    let name = first.display().to_string();
    let command = command_line(&["check"], &[&name]);
    let images = counted(images.len(), "image", "images");
    Some(format!("it has {images} (.png, .jpg, .webp): name those that are normal maps, as in `{command}`"))
}

/// Which images of a folder are named like normal maps and are used by none of its models, as a sentence;
/// none where there are none, and where a model may use all of them, because its names cannot be read.
pub fn unused_maps<'a>(folder: &Path, models: impl Iterator<Item = &'a Path>) -> Option<String> {
    let mut images = images(folder);
    images.retain(|path| is_named_like_normals(path));
    if images.is_empty() {
        return None;
    }
    for model in models {
        let named = names_in(model)?;
        images.retain(|path| path.file_name().is_none_or(|name| !named.contains(&*name.to_string_lossy())));
    }
    let first = images.first()?.display().to_string();
    let command = command_line(&["check"], &[&first]);
    let what = counted(images.len(), "image named like a normal map is", "images named like normal maps are");
    Some(format!(
        "{}: {what} used by no model there, and not checked; name such an image to check it, as in `{command}`",
        folder.display()
    ))
}

/// A text with the names of the images that a model uses: the JSON of a glTF, the textures of an OBJ's
/// libraries, or the start of another file. None where it cannot be read, or is the JSON of a glTF and has
/// more than is read of one.
fn names_in(model: &Path) -> Option<String> {
    if FileKind::of(model) == Some(FileKind::Obj) {
        let files = companions(model).unwrap_or_default();
        return Some(files.into_iter().map(|file| file.name + "\n").collect());
    }
    let mut file = open_regular(model, File::options().read(true), Links::Follow).ok()?;
    let text = match ModelJson::of(&mut file, model) {
        ModelJson::Text(text) => text,
        ModelJson::Unread => return None,
        ModelJson::Absent => {
            let mut start = Vec::new();
            file.rewind().ok()?;
            file.take(MOST_TEXT).read_to_end(&mut start).ok()?;
            start
        }
    };
    Some(String::from_utf8_lossy(&text).replace("%20", " "))
}

/// The most bytes of a file that is no glTF in which names are looked for.
const MOST_TEXT: u64 = 256 << 20;

/// The images of a folder.
fn images(folder: &Path) -> Vec<PathBuf> {
    let entries = WalkDir::new(folder).sort_by_file_name().into_iter().filter_map(Result::ok);
    let files = entries.filter(|entry| entry.file_type().is_file()).map(walkdir::DirEntry::into_path);
    files.filter(|path| is_image(path)).collect()
}

/// Whether a file name looks like that of a normal map.
fn is_named_like_normals(path: &Path) -> bool {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    ["normal", "nrm", "_nor", "_n"]
        .iter()
        .any(|part| name.contains(part) && (*part != "_n" || name.ends_with("_n")))
}

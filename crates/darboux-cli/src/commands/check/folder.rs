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
    Some(format!(
        "it has {images} (.png, .jpg, .webp, .tga): name those that are normal maps, as in `{command}`"
    ))
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
        drop_used(model, &mut images)?;
    }
    let first = images.first()?.display().to_string();
    let command = command_line(&["check"], &[&first]);
    let what = counted(images.len(), "image named like a normal map is", "images named like normal maps are");
    Some(format!(
        "{}: {what} used by no model there, and not checked; name such an image to check it, as in \
         `{command}`",
        folder.display()
    ))
}

/// Drops the images that a model names: in the JSON of a glTF, as textures of an OBJ's libraries, or anywhere
/// in the start of another file. None where it cannot be read, or is the JSON of a glTF and has more than is
/// read of one.
fn drop_used(model: &Path, images: &mut Vec<PathBuf>) -> Option<()> {
    if FileKind::of(model) == Some(FileKind::Obj) {
        let files = companions(model).unwrap_or_default();
        drop_named(&files.into_iter().map(|file| file.name + "\n").collect::<String>(), images);
        return Some(());
    }
    let mut file = open_regular(model, File::options().read(true), Links::Follow).ok()?;
    match ModelJson::of(&mut file, model) {
        ModelJson::Text(text) => drop_named(&String::from_utf8_lossy(&text), images),
        ModelJson::Unread => return None,
        ModelJson::Absent => {
            file.rewind().ok()?;
            drop_named_in_parts(file.take(MOST_TEXT), images)?;
        }
    }
    Some(())
}

/// The most bytes of a file that is no glTF in which names are looked for, how many of them at a time, and
/// the longest name that is found across two such parts.
const MOST_TEXT: u64 = 256 << 20;
const PART: u64 = 1 << 20;
const LONGEST_NAME: usize = 1024;

fn drop_named_in_parts(mut file: impl Read, images: &mut Vec<PathBuf>) -> Option<()> {
    let mut part = Vec::new();
    loop {
        part.drain(..part.len().saturating_sub(LONGEST_NAME));
        let read = file.by_ref().take(PART).read_to_end(&mut part).ok()?;
        drop_named(&String::from_utf8_lossy(&part), images);
        if read == 0 || images.is_empty() {
            return Some(());
        }
    }
}

/// Drops the images whose file names are in a text.
fn drop_named(text: &str, images: &mut Vec<PathBuf>) {
    let text = text.replace("%20", " ");
    images.retain(|path| path.file_name().is_none_or(|name| !text.contains(&*name.to_string_lossy())));
}

/// The images of a folder.
fn images(folder: &Path) -> Vec<PathBuf> {
    let entries = WalkDir::new(folder).sort_by_file_name().into_iter().filter_map(Result::ok);
    let files = entries.filter(|entry| entry.file_type().is_file()).map(walkdir::DirEntry::into_path);
    files.filter(|path| is_image(path)).collect()
}

/// Whether a file name looks like the name of a normal map.
fn is_named_like_normals(path: &Path) -> bool {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    ["normal", "nrm", "_nor", "_n"]
        .iter()
        .any(|part| name.contains(part) && (*part != "_n" || name.ends_with("_n")))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A name may lie across two parts.
    #[test]
    fn names_are_found_in_parts() {
        for before in [0, PART - 7, PART, 3 * PART - 1] {
            let mut images = ["wall_normal.png", "floor_normal.png"].map(PathBuf::from).to_vec();
            let name = std::io::Cursor::new(b"\xFFwall_normal.png\0");
            let file = std::io::repeat(b'n').take(before).chain(name).chain(std::io::repeat(0).take(PART));
            drop_named_in_parts(file, &mut images).expect("a file");
            assert_eq!(images, [PathBuf::from("floor_normal.png")], "after {before} bytes");
        }
    }
}

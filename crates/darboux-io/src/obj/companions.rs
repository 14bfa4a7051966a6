//! Finds the files that an OBJ refers to: its material libraries, and the textures that these name.

use std::fs;
use std::path::{Path, PathBuf};

use crate::Error;
use crate::error::Fault;

/// References in longer lines are ignored: no path has more bytes, and a reference may begin at every word of a line.
const LONGEST_LINE: usize = 4096;

/// What is wrong with a file without faces.
pub const NO_FACES: &str = "has no faces; is it an OBJ? Export it again";

/// A file that an OBJ refers to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Companion {
    /// The path relative to the folder of the OBJ, its parts separated by `/`.
    pub name: String,
    /// The path on this machine, links resolved.
    pub path: PathBuf,
}

/// The libraries and textures that the OBJ at `path` refers to. Files outside its folder and missing files are left out.
///
/// Errors: the file cannot be read; it has no faces.
pub fn companions(path: &Path) -> Result<Vec<Companion>, Error> {
    let bytes = fs::read(path).map_err(|source| Error::Read { file: path.to_owned(), source })?;
    let mut library_lines = Vec::new();
    let mut has_faces = false;
    for (word, rest) in statements(&bytes) {
        has_faces |= word == b"f";
        if word == b"mtllib" {
            library_lines.push(rest);
        }
    }
    if !has_faces {
        return Err(Fault::invalid("", NO_FACES).in_file(&path.display().to_string()));
    }
    let folder = folder_of(path)?;
    let mut companions = Vec::new();
    for library in library_lines.into_iter().flat_map(|line| libraries_of(&folder, line)) {
        if companions.contains(&library) {
            continue;
        }
        for texture in fs::read(&library.path).iter().flat_map(|text| textures(&folder, &library.name, text))
        {
            if !companions.contains(&texture) {
                companions.push(texture);
            }
        }
        companions.push(library);
    }
    Ok(companions)
}

/// The folder of a file, links resolved.
pub fn folder_of(path: &Path) -> Result<PathBuf, Error> {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    parent.canonicalize().map_err(|source| Error::Read { file: parent.to_owned(), source })
}

/// The libraries that a `mtllib` line names: one whose name may contain spaces, or several.
pub fn libraries_of(folder: &Path, line: &[u8]) -> Vec<Companion> {
    if line.len() > LONGEST_LINE {
        return Vec::new();
    }
    let words = || line.split(u8::is_ascii_whitespace).filter_map(|word| inside(folder, "", word));
    inside(folder, "", line).map_or_else(|| words().collect(), |library| vec![library])
}

/// The textures of a material library.
fn textures(folder: &Path, library: &str, text: &[u8]) -> Vec<Companion> {
    let maps = statements(text).filter(|(word, _)| is_texture(word));
    maps.filter_map(|(_, line)| texture(folder, library, line)).collect()
}

/// The texture that a statement of a material library names.
///
/// Options may stand before the name, and the name may contain spaces, so the longest end of the line that names a file is taken.
pub fn texture(folder: &Path, library: &str, line: &[u8]) -> Option<Companion> {
    if line.len() > LONGEST_LINE {
        return None;
    }
    let starts = line.iter().enumerate().filter(|&(i, _)| i == 0 || line[i - 1].is_ascii_whitespace());
    starts.map(|(i, _)| &line[i..]).find_map(|end| inside(folder, library, end))
}

fn is_texture(word: &[u8]) -> bool {
    let word = word.to_ascii_lowercase();
    word.starts_with(b"map_") || [&b"norm"[..], b"bump", b"disp", b"decal", b"refl"].contains(&&word[..])
}

/// The statements of an OBJ or MTL: the first word of every line, and the rest of the line.
fn statements(text: &[u8]) -> impl Iterator<Item = (&[u8], &[u8])> {
    text.split(|&byte| byte == b'\n' || byte == b'\r').map(|line| {
        let line = line.trim_ascii();
        let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
        (&line[..end], line[end..].trim_ascii())
    })
}

/// The file that `reference` names, relative to the file `base`; none unless it is a file in `folder` or below, links followed.
fn inside(folder: &Path, base: &str, reference: &[u8]) -> Option<Companion> {
    let reference = str::from_utf8(reference).ok()?.replace('\\', "/");
    let mut parts: Vec<&str> = base.split('/').collect();
    parts.pop();
    for part in reference.split('/') {
        match part {
            "" | "." => {}
            ".." => _ = parts.pop()?,
            part => parts.push(part),
        }
    }
    let name = parts.join("/");
    let path = folder.join(&name).canonicalize().ok()?;
    let is_inside = !reference.starts_with('/') && path.starts_with(folder) && path.is_file();
    is_inside.then_some(Companion { name, path })
}

//! Finds the files that an OBJ refers to: its material libraries, and the textures that these name.

use std::cell::{Cell, RefCell};
use std::collections::{HashMap, HashSet};
use std::io;
use std::path::{Path, PathBuf};

use super::statements::statements;
use crate::error::ContentError;
use crate::{Error, paths};

/// References in longer lines are ignored: no path has more bytes, and a reference may begin at every word of
/// a line.
const LONGEST_LINE: usize = 4096;

/// The most paths that are looked up for one OBJ. Every word of a library may be a path, and each lookup asks
/// the operating system.
const MAX_LOOKUPS: usize = 100_000;

/// What is wrong with a file without faces.
pub const NO_FACES: &str = "has no faces; is it an OBJ? Export it again";

/// A file that an OBJ refers to.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Companion {
    /// The path relative to the folder of the OBJ, its parts separated by `/`.
    pub name: String,
    /// The path on this machine, links resolved.
    pub path: PathBuf,
}

impl Companion {
    /// The content of the file. Errors: the file cannot be read; it is no longer a regular file without links
    /// in its path.
    pub fn read(&self) -> io::Result<Vec<u8>> {
        paths::read_resolved(&self.path)
    }
}

/// The libraries and textures that the OBJ at `path` refers to. Files outside its folder and missing files
/// are left out.
///
/// Errors: the file cannot be read; it has no faces.
pub fn companions(path: &Path) -> Result<Vec<Companion>, Error> {
    let bytes = paths::resolve_input(path).and_then(|input| {
        paths::read_resolved(&input).map_err(|source| Error::Read { file: path.to_owned(), source })
    })?;
    let mut library_lines = Vec::new();
    let mut has_faces = false;
    for (_, word, rest) in statements(&bytes) {
        has_faces |= word == b"f";
        if word == b"mtllib" {
            library_lines.push(rest);
        }
    }
    if !has_faces {
        return Err(ContentError::invalid("", NO_FACES).in_file(&path.display().to_string()));
    }
    let lookup = FileLookup::new(folder_of(path)?);
    let (mut companions, mut seen) = (Vec::new(), HashSet::new());
    for library in library_lines.into_iter().flat_map(|line| lookup.libraries(line)) {
        if !seen.insert(library.path.clone()) {
            continue;
        }
        let text = library.read().unwrap_or_default();
        let maps = statements(&text).filter(|(_, word, _)| is_texture(word));
        let textures = maps.filter_map(|(_, _, line)| lookup.texture(&library.name, line));
        companions.extend(textures.filter(|texture| seen.insert(texture.path.clone())));
        companions.push(library);
    }
    Ok(companions)
}

/// The folder of a file, links resolved.
fn folder_of(path: &Path) -> Result<PathBuf, Error> {
    let parent = paths::folder_of(path);
    parent.canonicalize().map_err(|source| Error::Read { file: parent.to_owned(), source })
}

/// The name of a library, and a line of it.
type TextureLine = (String, Vec<u8>);

/// Looks up the files that lines refer to, each distinct line once.
struct FileLookup {
    folder: PathBuf,
    libraries: RefCell<HashMap<Vec<u8>, Vec<Companion>>>,
    textures: RefCell<HashMap<TextureLine, Option<Companion>>>,
    /// The number of paths that may still be looked up.
    left: Cell<usize>,
}

impl FileLookup {
    /// Files are looked up in `folder`, links resolved.
    fn new(folder: PathBuf) -> Self {
        let (libraries, textures) = Default::default();
        Self { folder, libraries, textures, left: Cell::new(MAX_LOOKUPS) }
    }

    /// The libraries that a `mtllib` line names: one whose name may contain spaces, or several.
    fn libraries(&self, line: &[u8]) -> Vec<Companion> {
        if line.len() > LONGEST_LINE {
            return Vec::new();
        }
        let find = || {
            let words = line.split(u8::is_ascii_whitespace).filter_map(|word| self.find("", word));
            self.find("", line).map_or_else(|| words.collect(), |library| vec![library])
        };
        self.libraries.borrow_mut().entry(line.to_owned()).or_insert_with(find).clone()
    }

    /// The texture that a statement of a material library names.
    ///
    /// Options may stand before the name, and the name may contain spaces, so the longest end of the line
    /// that names a file is taken.
    fn texture(&self, library: &str, line: &[u8]) -> Option<Companion> {
        if line.len() > LONGEST_LINE {
            return None;
        }
        let find = || {
            let is_start = |&i: &usize| i == 0 || line[i - 1].is_ascii_whitespace();
            (0..line.len()).filter(is_start).find_map(|start| self.find(library, &line[start..]))
        };
        self.textures.borrow_mut().entry((library.to_owned(), line.to_owned())).or_insert_with(find).clone()
    }

    /// The file that `reference` names, relative to the file `base`; none unless it is a file in the folder
    /// or below, links followed.
    fn find(&self, base: &str, reference: &[u8]) -> Option<Companion> {
        self.left.set(self.left.get().checked_sub(1)?);
        inside(&self.folder, base, reference)
    }
}

fn is_texture(word: &[u8]) -> bool {
    let word = word.to_ascii_lowercase();
    word.starts_with(b"map_") || [&b"norm"[..], b"bump", b"disp", b"decal", b"refl"].contains(&&word[..])
}

/// The file that `reference` names, relative to the file `base`; none unless it is a file in `folder` or
/// below, links followed.
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

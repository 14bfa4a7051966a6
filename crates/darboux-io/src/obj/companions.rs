//! Finds the files that an OBJ refers to: its material libraries, and the textures that these name.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::io;
use std::path::{Path, PathBuf};

use super::lookup::{self, Found};
use super::statements::{is_face, statements};
use super::texture_map::MtlMap;
use crate::error::ContentError;
use crate::source::{FileSource, FoundFile, ModelFiles};
use crate::{Error, LoadOptions, paths};

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

/// The libraries and textures that the OBJ at `path` refers to, found as its reader finds them. Files outside
/// its folder and missing files are left out.
///
/// Errors: the file cannot be read; it has no faces.
pub fn companions(path: &Path) -> Result<Vec<Companion>, Error> {
    let bytes = paths::resolve_input(path).and_then(|input| {
        paths::read_resolved(&input).map_err(|source| Error::Read { file: path.to_owned(), source })
    })?;
    let mut library_lines = Vec::new();
    let mut has_faces = false;
    for (_, word, rest) in statements(&bytes) {
        has_faces |= is_face(word);
        if word == b"mtllib" {
            library_lines.push(rest);
        }
    }
    if !has_faces {
        return Err(ContentError::invalid("", NO_FACES).in_file(&path.display().to_string()));
    }
    let lookup = FileLookup::new(path)?;
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
    files: ModelFiles,
    libraries: RefCell<HashMap<Vec<u8>, Vec<Companion>>>,
    textures: RefCell<HashMap<TextureLine, Option<Companion>>>,
}

impl FileLookup {
    fn new(model: &Path) -> Result<Self, Error> {
        let (libraries, textures) = Default::default();
        let source = FileSource::Folder(folder_of(model)?);
        let files = ModelFiles::new(&model.to_string_lossy(), source, &LoadOptions::default());
        Ok(Self { files, libraries, textures })
    }

    fn libraries(&self, line: &[u8]) -> Vec<Companion> {
        let find =
            || lookup::libraries(&self.files, line).into_iter().flatten().map(Companion::from).collect();
        self.libraries.borrow_mut().entry(line.to_owned()).or_insert_with(find).clone()
    }

    fn texture(&self, library: &str, line: &[u8]) -> Option<Companion> {
        let find = || lookup::texture(&self.files, library, &MtlMap::parse(line)).map(Companion::from);
        self.textures.borrow_mut().entry((library.to_owned(), line.to_owned())).or_insert_with(find).clone()
    }
}

impl From<Found> for Companion {
    fn from((_, FoundFile { name, path, .. }): Found) -> Self {
        Self { name, path }
    }
}

fn is_texture(word: &[u8]) -> bool {
    let word = word.to_ascii_lowercase();
    word.starts_with(b"map_") || [&b"norm"[..], b"bump", b"disp", b"decal", b"refl"].contains(&&word[..])
}

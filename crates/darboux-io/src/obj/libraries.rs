//! Material libraries (MTL): their materials, with the textures located in the model's folder.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use tobj::LoadError;

use super::companions::{Companion, FileLookup};
use crate::error::system_reason;

/// A material of a library.
pub struct LibraryMaterial {
    pub name: String,
    /// The statement `Kd`, in sRGB.
    pub color: [f32; 3],
    /// The statement `map_Kd`.
    pub color_texture: Option<Companion>,
    /// The statement `norm`.
    pub normal_texture: Option<Companion>,
    /// The statements for heights, where many programs write normal maps.
    pub bump_texture: Option<Companion>,
}

/// The libraries that an OBJ names, loaded while the parser meets their names. Each library is loaded once.
pub struct MaterialLibraries {
    lookup: FileLookup,
    loaded: RefCell<HashSet<PathBuf>>,
    /// All materials in the order of loading, which is the order of the parser's material indices.
    materials: RefCell<Vec<LibraryMaterial>>,
    warnings: RefCell<Vec<String>>,
}

impl MaterialLibraries {
    /// Libraries are looked up in `folder`, links resolved.
    pub fn new(folder: PathBuf) -> Self {
        Self {
            lookup: FileLookup::new(folder),
            loaded: RefCell::default(),
            materials: RefCell::default(),
            warnings: RefCell::default(),
        }
    }

    /// All materials, and one sentence for each library or texture that is missing.
    pub fn into_parts(self) -> (Vec<LibraryMaterial>, Vec<String>) {
        (self.materials.into_inner(), self.warnings.into_inner())
    }

    /// The materials of the libraries that a `mtllib` line names for the first time, and their indices by name.
    pub fn load(&self, line: &Path) -> (Vec<tobj::Material>, HashMap<String, usize>) {
        let line = line.to_string_lossy();
        let mut materials = Vec::new();
        let libraries = self.lookup.libraries(line.as_bytes());
        if libraries.is_empty() {
            self.warn(format!("{}; its materials are left out", self.lookup.problem(&line)));
        }
        for library in libraries {
            if !self.loaded.borrow_mut().insert(library.path.clone()) {
                continue;
            }
            match parse_library(&library) {
                Ok(parsed) => {
                    let located = parsed.iter().map(|material| self.locate(&library.name, material));
                    self.materials.borrow_mut().extend(located);
                    materials.extend(parsed);
                }
                Err(problem) => self.warn(format!("{}: {problem}", library.name)),
            }
        }
        let indices = materials.iter().enumerate().map(|(i, material)| (material.name.clone(), i)).collect();
        (materials, indices)
    }

    fn locate(&self, library: &str, material: &tobj::Material) -> LibraryMaterial {
        let located = |line: Option<&String>| {
            let line = line?;
            let file = self.lookup.texture(library, line.as_bytes());
            if file.is_none() {
                self.warn(format!("{library}: {}; the texture is left out", self.lookup.problem(line)));
            }
            file
        };
        LibraryMaterial {
            name: material.name.clone(),
            color: material.diffuse.unwrap_or([1.0; 3]),
            color_texture: located(material.diffuse_texture.as_ref()),
            normal_texture: located(material.unknown_param.get("norm")),
            bump_texture: located(material.normal_texture.as_ref()),
        }
    }

    fn warn(&self, sentence: String) {
        self.warnings.borrow_mut().push(sentence);
    }
}

/// The materials of a library. The error is a clause whose subject is the library.
fn parse_library(library: &Companion) -> Result<Vec<tobj::Material>, String> {
    let bytes = library
        .read()
        .map_err(|error| format!("cannot be read: {}; its materials are left out", system_reason(&error)))?;
    let text = String::from_utf8_lossy(&bytes);
    // The parser panics at colours with one or two numbers.
    let is_whole = |line: &str| {
        let mut words = line.split_whitespace();
        !["Ka", "Kd", "Ks", "Ke"].contains(&words.next().unwrap_or_default()) || words.count() >= 3
    };
    let parsed = match text.lines().all(is_whole) {
        true => tobj::load_mtl_buf(&mut text.as_bytes()),
        false => Err(LoadError::ColorParseError),
    };
    let (materials, _) = parsed.map_err(|error| format!("cannot be read ({error}); export it again"))?;
    Ok(materials)
}

//! The model that the viewer's page shows, as files for the server.

use std::fs::OpenOptions;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use darboux_io::gltf::{Document, inspect};
use darboux_io::obj::{Companion, companions};
use darboux_io::{FileKind, LoadOptions, resolve_input, system_reason};

use crate::regular_file::{Links, open_regular};

/// A model, which is read again at every request.
pub struct ServedModel {
    path: PathBuf,
    kind: ModelKind,
    options: LoadOptions,
}

enum ModelKind {
    /// A glTF file, or what becomes one.
    Gltf,
    /// An OBJ with the material libraries and textures that it refers to.
    Obj(Vec<Companion>),
}

impl ServedModel {
    /// Reads the model once, so that a broken file is reported before the server starts. Errors: the file
    /// cannot be read, has another format or is broken.
    pub fn find(path: &Path, options: LoadOptions) -> Result<Self, String> {
        resolve_input(path).map_err(|error| error.to_string())?;
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let kind = match extension.to_str() {
            Some("obj") => ModelKind::Obj(companions(path).map_err(|error| error.to_string())?),
            _ => ModelKind::Gltf,
        };
        let model = Self { path: path.to_owned(), kind, options };
        if let ModelKind::Gltf = model.kind {
            model.open().and_then(|document| inspect(&document)).map_err(|error| error.to_string())?;
        }
        Ok(model)
    }

    /// The names of the files that are sent: the model, then the companions of an OBJ.
    pub fn names(&self) -> Vec<String> {
        let keeps_name =
            matches!(self.kind, ModelKind::Obj(_)) || FileKind::of(&self.path).is_some_and(FileKind::is_gltf);
        // What becomes a GLB is called so, for the page goes by the name.
        let path = if keeps_name { self.path.clone() } else { self.path.with_extension("glb") };
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let companions = match &self.kind {
            ModelKind::Gltf => &[][..],
            ModelKind::Obj(companions) => companions,
        };
        [name].into_iter().chain(companions.iter().map(|companion| companion.name.clone())).collect()
    }

    /// The content of the file with an index in [`ServedModel::names`]; `None` for an index past the end. An
    /// OBJ and its companions are sent unchanged; a glTF file is sent as a GLB with its buffers and
    /// images. Errors: one sentence about the file.
    pub fn read(&self, index: usize) -> Option<Result<Vec<u8>, String>> {
        let unchanged = |path: &Path| {
            read_regular(path)
                .map_err(|error| format!("{}: cannot be read: {}", path.display(), system_reason(&error)))
        };
        match (&self.kind, index) {
            (ModelKind::Gltf, 0) => {
                Some(self.open().and_then(|document| document.to_glb()).map_err(|error| error.to_string()))
            }
            (ModelKind::Gltf, _) => None,
            (ModelKind::Obj(_), 0) => Some(unchanged(&self.path)),
            (ModelKind::Obj(companions), index) => {
                let companion = companions.get(index - 1)?;
                let shown = companion.path.display();
                Some(
                    companion
                        .read()
                        .map_err(|error| format!("{shown}: cannot be read: {}", system_reason(&error))),
                )
            }
        }
    }

    fn open(&self) -> Result<Document, darboux_io::Error> {
        Document::open(&self.path, &self.options)
    }
}

fn read_regular(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_regular(path, OpenOptions::new().read(true), Links::Follow)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

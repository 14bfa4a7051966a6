//! The model that the page shows.

use std::fs;
use std::path::{Path, PathBuf};

use darboux_io::gltf::{Document, LoadOptions};

/// A model, read anew whenever the page asks for it.
pub struct Model {
    path: PathBuf,
    kind: Kind,
    allow_outside: bool,
}

enum Kind {
    Gltf,
    Obj,
}

impl Model {
    /// Errors: no such file, another format.
    pub fn find(path: &Path, allow_outside: bool) -> Result<Self, String> {
        let shown = path.display();
        let metadata = fs::metadata(path).map_err(|error| format!("{shown}: cannot be read: {error}"))?;
        if !metadata.is_file() {
            return Err(format!("{shown}: is not a file; name a model"));
        }
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let kind = match extension.to_str() {
            Some("gltf" | "glb" | "vrm") => Kind::Gltf,
            Some("obj") => Kind::Obj,
            _ => return Err(format!("{shown}: cannot be shown; give a .gltf, .glb, .vrm or .obj")),
        };
        Ok(Self { path: path.to_owned(), kind, allow_outside })
    }

    /// The name under which the page has it: that of the file, ending in what is sent.
    pub fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        let sent = match self.kind {
            Kind::Gltf => Path::new(name).with_extension("glb"),
            Kind::Obj => name.into(),
        };
        sent.to_string_lossy().into_owned()
    }

    /// What is sent: an OBJ as it is, all else as a GLB that holds its buffers and images. Errors: a sentence about the file.
    pub fn read(&self) -> Result<Vec<u8>, String> {
        match self.kind {
            Kind::Obj => fs::read(&self.path)
                .map_err(|error| format!("{}: cannot be read: {error}", self.path.display())),
            Kind::Gltf => {
                let options = LoadOptions { allow_outside: self.allow_outside };
                let document = Document::open(&self.path, &options);
                document.and_then(|document| document.to_glb()).map_err(|error| error.to_string())
            }
        }
    }
}

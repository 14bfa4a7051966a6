//! The model that the page shows.

use std::fs;
use std::path::{Path, PathBuf};

use darboux_io::gltf::{Document, LoadOptions, inspect};
use darboux_io::obj::{Companion, companions};
use darboux_io::readable;

/// A model, read anew whenever the page asks for it.
pub struct Model {
    path: PathBuf,
    kind: Kind,
    options: LoadOptions,
}

enum Kind {
    Gltf,
    /// With what it refers to.
    Obj(Vec<Companion>),
}

impl Model {
    /// Reads the model once, so that a broken one is known before there is a page. Errors: no such file, another format, broken data.
    pub fn find(path: &Path, options: LoadOptions) -> Result<Self, String> {
        let shown = path.display();
        readable(path).map_err(|error| error.to_string())?;
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let kind = match extension.to_str() {
            Some("gltf" | "glb" | "vrm") => Kind::Gltf,
            Some("obj") => Kind::Obj(companions(path).map_err(|error| error.to_string())?),
            _ => return Err(format!("{shown}: cannot be shown; give a .gltf, .glb, .vrm or .obj")),
        };
        let model = Self { path: path.to_owned(), kind, options };
        if let Kind::Gltf = model.kind {
            model
                .open()
                .and_then(|mut document| inspect(&mut document))
                .map_err(|error| error.to_string())?;
        }
        Ok(model)
    }

    /// The names of what is sent: the model's, ending in what it is sent as, then what an OBJ refers to.
    pub fn names(&self) -> Vec<String> {
        let name = self.path.file_name().unwrap_or_default();
        match &self.kind {
            Kind::Gltf => vec![Path::new(name).with_extension("glb").to_string_lossy().into_owned()],
            Kind::Obj(companions) => {
                let names = companions.iter().map(|companion| companion.name.clone());
                [name.to_string_lossy().into_owned()].into_iter().chain(names).collect()
            }
        }
    }

    /// What is sent under the name at a place of [`Model::names`]; none past their end. An OBJ and what it refers to are sent as they are,
    /// all else as a GLB that holds its buffers and images. Errors: a sentence about the file.
    pub fn read(&self, at: usize) -> Option<Result<Vec<u8>, String>> {
        let as_it_is = |path: &Path| {
            fs::read(path).map_err(|error| format!("{}: cannot be read: {error}", path.display()))
        };
        match (&self.kind, at) {
            (Kind::Gltf, 0) => {
                Some(self.open().and_then(|document| document.to_glb()).map_err(|error| error.to_string()))
            }
            (Kind::Gltf, _) => None,
            (Kind::Obj(_), 0) => Some(as_it_is(&self.path)),
            (Kind::Obj(companions), at) => companions.get(at - 1).map(|companion| as_it_is(&companion.path)),
        }
    }

    fn open(&self) -> Result<Document, darboux_io::Error> {
        Document::open(&self.path, &self.options)
    }
}

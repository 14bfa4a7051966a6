//! The document: what was read, what is edited.

use std::path::{Path, PathBuf};

use darboux::MeshError;
use serde_json::{Map, Value};

use super::{Elements, NewAccessor, schema};
use crate::Error;

/// How a document is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadOptions {
    /// Also read files outside the input's folder: `..`, absolute paths, links.
    pub allow_outside: bool,
}

/// How a document is written.
#[derive(Clone, Copy, Debug, Default)]
pub struct SaveOptions {
    /// Replace an existing output; without, that is an error.
    pub force: bool,
}

/// A glTF document: read once, edited, written elsewhere or in place.
#[derive(Debug)]
pub struct Document {
    name: String,
}

impl Document {
    /// Reads a `.glb` or `.gltf` file; its first bytes decide which. Errors: see [`Error`].
    pub fn open(path: &Path, options: &LoadOptions) -> Result<Self, Error> {
        let _ = (path, options);
        todo!()
    }

    /// Reads a document from memory. `name` stands for the file in messages; `base` is the folder of external files, without
    /// which buffers must be embedded.
    pub fn from_bytes(
        name: &str,
        bytes: Vec<u8>,
        base: Option<&Path>,
        options: &LoadOptions,
    ) -> Result<Self, Error> {
        let _ = (name, bytes, base, options);
        todo!()
    }

    /// The name in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What is odd but not an error, such as missing images: one sentence each.
    pub fn warnings(&self) -> &[String] {
        todo!()
    }

    /// The meshes, edits included.
    pub fn meshes(&self) -> &[schema::Mesh] {
        todo!()
    }

    /// The materials.
    pub fn materials(&self) -> &[schema::Material] {
        todo!()
    }

    /// The accessors, new ones included.
    pub fn accessors(&self) -> &[schema::Accessor] {
        todo!()
    }

    /// The values of an accessor as floats: normalised integers as fractions, other integers as numbers, sparse elements in
    /// place, zeros without a buffer view. Errors: another number of components than `N`; bytes that are not there.
    pub fn read_vectors<const N: usize>(&self, accessor: usize) -> Result<Vec<[f32; N]>, Error> {
        let _ = accessor;
        todo!()
    }

    /// The values of an accessor of unsigned integers. Errors: another type; bytes that are not there.
    pub fn read_indices(&self, accessor: usize) -> Result<Vec<u32>, Error> {
        let _ = accessor;
        todo!()
    }

    /// The elements of an accessor as bytes, to gather and to write again. Errors: bytes that are not there.
    pub fn read_elements(&self, accessor: usize) -> Result<Elements, Error> {
        let _ = accessor;
        todo!()
    }

    /// Appends an accessor with a buffer view of its own; gives its index.
    pub fn push_accessor(&mut self, data: NewAccessor) -> usize {
        let _ = data;
        todo!()
    }

    /// Edits a primitive. The map holds what is understood (`attributes`, `indices`, `material`, `mode`, `targets`,
    /// `extensions`); its other members, and those that `edit` leaves equal, stay as they are written in the file.
    /// Errors: no such primitive; a result that is no primitive.
    pub fn edit_primitive(
        &mut self,
        mesh: usize,
        primitive: usize,
        edit: impl FnOnce(&mut Map<String, Value>),
    ) -> Result<(), Error> {
        let _ = (mesh, primitive, edit);
        todo!()
    }

    /// Whether any data is compressed, so that [`Document::decompress`] has work.
    pub fn is_compressed(&self) -> bool {
        todo!()
    }

    /// Decodes all compressed meshes and buffer views and removes the extensions. Must come before accessors are read.
    pub fn decompress(&mut self) -> Result<(), Error> {
        todo!()
    }

    /// Whether there are edits.
    pub fn is_changed(&self) -> bool {
        todo!()
    }

    /// The document as a GLB that holds everything but `http(s)` resources.
    pub fn to_glb(&self) -> Result<Vec<u8>, Error> {
        todo!()
    }

    /// Writes the document; gives the files written, the document itself last. The extension decides the container.
    ///
    /// Errors: an existing output without [`SaveOptions::force`]; the input itself as output; see [`Error`]. What an error
    /// leaves behind: nothing.
    pub fn save(&self, path: &Path, options: &SaveOptions) -> Result<Vec<PathBuf>, Error> {
        let _ = (path, options);
        todo!()
    }

    /// Replaces the input file, keeping its container and its permissions.
    pub fn save_in_place(&self) -> Result<Vec<PathBuf>, Error> {
        todo!()
    }

    /// The error that says `problem` about the JSON path `at`.
    pub fn invalid(&self, at: impl Into<String>, problem: impl Into<String>) -> Error {
        Error::Invalid { file: self.name.clone(), at: at.into(), problem: problem.into() }
    }

    /// The error that says what is wrong with the mesh of the primitive at `at`.
    pub fn mesh_error(&self, at: impl Into<String>, source: MeshError) -> Error {
        Error::Mesh { file: self.name.clone(), at: at.into(), source }
    }
}

//! A glTF document: its JSON and its buffers, which reading fills, edits change, and writing stores.

use std::collections::{BTreeMap, HashSet};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Mutex, OnceLock};

use crate::json::Value;
use serde::de::DeserializeOwned;

use super::buffers::{BufferSource, ImageFile};
use super::container::Container;
use super::file_bytes::FileBytes;
use super::references::Unreferenced;
use super::resources::Resources;
use super::schema::{self, Root};
use crate::error::ContentError;
use crate::json::{self, TextLayout};
use crate::memory_limit::Budget;
use crate::source::Provenance;
use crate::{Error, LoadOptions};

/// A glTF document: read from a file, edited, and written to another file or in place.
///
/// Everything that is not edited is kept, unknown extensions, the order of keys and the spelling of numbers
/// included. A document without edits is written byte for byte. Compressed meshes are decoded when the
/// document is read, and written without compression if there are edits.
#[derive(Debug)]
pub struct Document {
    pub(super) name: String,
    /// The input file, links resolved.
    pub(super) input: Option<PathBuf>,
    /// The whole file as it was read.
    pub(super) file: FileBytes,
    pub(super) container: Container,
    /// The JSON with all edits.
    pub(super) json: Value,
    /// The layout of the JSON as it was read.
    pub(super) layout: TextLayout,
    /// Parts of the JSON as types; every edit renews what it changes (`edit.rs`).
    pub(super) root: Root,
    pub(super) resources: Resources,
    /// The bytes of each buffer.
    pub(super) buffers: Vec<BufferSource>,
    /// The new content of images that are files, by the index of the image.
    pub(super) image_files: BTreeMap<usize, ImageFile>,
    pub(super) is_changed: bool,
    /// Whether the input has compressed data; the JSON and the buffers no longer have.
    pub(super) was_compressed: bool,
    /// What nothing in the input refers to, and is kept.
    pub(super) unreferenced: Unreferenced,
    /// The ranges of buffers that held compressed views, by the buffer.
    pub(super) decoded_ranges: Vec<(usize, Range<usize>)>,
    /// The number of new bytes that came from compressed meshes.
    pub(super) decompressed_bytes: usize,
    pub(super) options: LoadOptions,
    /// The most elements of an accessor with a buffer view.
    pub(super) backed_count: OnceLock<usize>,
    /// The accessors whose sparse indices were found to ascend.
    pub(super) checked_sparse: Mutex<HashSet<usize>>,
    /// Whether a warning about unused data that stays has been given.
    pub(super) is_unused_data_reported: bool,
    pub(super) warnings: Vec<String>,
    /// Where it came from, if the file has another format.
    pub(super) provenance: Option<Provenance>,
}

impl Document {
    /// The memory that may be computed for a document of this size, or decompressed from it.
    pub(super) fn memory_limit(&self) -> Budget {
        let [read, decompressed] = self.sizes();
        self.options.budget(read, decompressed)
    }

    /// The bytes of the file and of its buffers, without images that are files.
    pub fn source_size(&self) -> usize {
        self.sizes()[0]
    }

    /// The bytes that were read, and those that were decompressed.
    fn sizes(&self) -> [usize; 2] {
        let embedded = self.buffers.iter().map(|source| match source {
            BufferSource::Chunk | BufferSource::Absent(_) | BufferSource::New(_) => [0, 0],
            BufferSource::File(file) => [file.bytes.len(), 0],
            BufferSource::Data(bytes) => [bytes.len(), 0],
            BufferSource::Decoded(bytes) => [0, bytes.len()],
        });
        let start = [self.file.len(), self.decompressed_bytes];
        embedded.fold(start, |sum, bytes| [sum[0] + bytes[0], sum[1] + bytes[1]])
    }

    /// The most bytes that may be decoded from `size` bytes of an image: the memory limit of [`LoadOptions`]
    /// for a file of this size.
    pub fn memory_limit_of(&self, size: usize) -> u64 {
        self.options.budget(size, 0).bytes as u64
    }

    /// The options that the document was read with.
    pub fn load_options(&self) -> &LoadOptions {
        &self.options
    }

    /// The name of the document in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Problems that are not errors, such as missing images: one sentence each.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Where the document came from, if it was read from another format than glTF.
    pub fn provenance(&self) -> Option<&Provenance> {
        self.provenance.as_ref()
    }

    /// The JSON, edits included.
    pub fn json(&self) -> &Value {
        &self.json
    }

    /// The meshes, edits included.
    pub fn meshes(&self) -> &[schema::Mesh] {
        &self.root.meshes
    }

    /// The materials.
    pub(super) fn stored_materials(&self) -> &[schema::Material] {
        &self.root.materials
    }

    /// The accessors, new ones included.
    pub fn accessors(&self) -> &[schema::Accessor] {
        &self.root.accessors
    }

    /// Whether there are edits.
    pub fn is_changed(&self) -> bool {
        self.is_changed
    }

    /// The JSON as another type.
    pub(super) fn read<T: DeserializeOwned>(&self) -> Result<T, ContentError> {
        json::read(&self.json, "")
    }

    /// The JSON of an element of an array of the root object; null if it does not exist.
    pub(super) fn element(&self, array: &str, index: usize) -> &Value {
        &self.json[array][index]
    }

    /// The bytes of a buffer view, and its stride. `at` is the JSON path that refers to it.
    pub(super) fn view(&self, index: usize, at: &str) -> Result<(&[u8], Option<usize>), ContentError> {
        let views = &self.root.buffer_views;
        let view = views.get(index).ok_or_else(|| {
            let problem = format!("buffer view {index} does not exist: there are {}", views.len());
            ContentError::invalid(at, format!("{problem}; export the file again"))
        })?;
        let at = || format!("bufferViews[{index}]");
        let bytes = self.buffer_range(view.buffer, view.byte_offset, view.byte_length, at)?;
        Ok((bytes, view.byte_stride))
    }

    /// A range of a buffer. `at` is the JSON path that refers to it.
    pub(super) fn buffer_range(
        &self,
        buffer: usize,
        offset: usize,
        length: usize,
        at: impl Fn() -> String,
    ) -> Result<&[u8], ContentError> {
        if let Some(BufferSource::New(bytes)) = self.buffers.get(buffer) {
            return bytes
                .range(offset, length)
                .ok_or_else(|| outside_buffer(offset, length, bytes.len(), &at()));
        }
        let bytes = self.buffer(buffer, || format!("{}.buffer", at()))?;
        let range = offset.checked_add(length).and_then(|end| bytes.get(offset..end));
        range.ok_or_else(|| outside_buffer(offset, length, bytes.len(), &at()))
    }

    /// The bytes of a buffer of the input; none for the buffer of new bytes. `at` is the JSON path that
    /// refers to it.
    pub(super) fn buffer(&self, index: usize, at: impl Fn() -> String) -> Result<&[u8], ContentError> {
        let (Some(buffer), Some(source)) = (self.root.buffers.get(index), self.buffers.get(index)) else {
            let problem = format!("buffer {index} does not exist: there are {}", self.root.buffers.len());
            return Err(ContentError::invalid(at(), format!("{problem}; export the file again")));
        };
        let bytes = match source {
            BufferSource::Chunk => &self.file[self.container.bin.clone().unwrap_or_default()],
            BufferSource::File(file) => &file.bytes,
            BufferSource::Data(bytes) | BufferSource::Decoded(bytes) => bytes,
            BufferSource::New(_) => &[],
            BufferSource::Absent(why) => {
                return Err(ContentError::resource(format!("buffers[{index}]"), *why));
            }
        };
        // A source may be longer than its buffer: the GLB's chunk is padded.
        Ok(&bytes[..buffer.byte_length.min(bytes.len())])
    }

    /// The error [`Error::Invalid`] about the JSON path `at`.
    pub(crate) fn invalid(&self, at: impl Into<String>, problem: impl Into<String>) -> Error {
        ContentError::invalid(at, problem).in_file(&self.name)
    }

    /// The error [`Error::Mesh`] about the primitive at the JSON path `at`.
    pub(crate) fn mesh_error(&self, at: impl Into<String>, source: darboux::Error) -> Error {
        Error::Mesh { file: self.name.clone(), at: at.into(), source }
    }
}

/// The error about a range that does not fit its buffer. `at` is the JSON path of the range.
pub(super) fn outside_buffer(offset: usize, length: usize, buffer_length: usize, at: &str) -> ContentError {
    let problem =
        format!("{length} bytes from byte {offset} on do not fit the buffer of {buffer_length} bytes");
    ContentError::invalid(at, format!("{problem}; export the file again"))
}

//! A glTF document: the file as it was read, and the edits to it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::value::RawValue;
use serde_json::{Map, Value};

use super::container::Container;
use super::elements::{Elements, NewAccessor, Target};
use super::file_bytes::{FileAccess, FileBytes};
use super::json_text;
use super::references;
use super::resources::{ResourceFile, Resources, UriTarget, decode_data_uri};
use super::schema::{self, ComponentType, Probe, Root};
use crate::error::Fault;
use crate::memory_limit::{self, MemoryLimit};
use crate::{Error, paths};

/// How a document is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadOptions {
    /// Also reads files outside the input's folder, through `..`, absolute paths or links.
    pub allow_outside: bool,
    /// The most memory that decoding the file, and computing from it, may take.
    pub memory_limit: MemoryLimit,
}

/// A glTF document: read from a file, edited, and written to another file or in place.
///
/// Everything that is not edited is kept as text and bytes, unknown extensions and the spelling of numbers included.
#[derive(Debug)]
pub struct Document {
    name: String,
    /// The input file, links resolved.
    pub(super) input: Option<PathBuf>,
    /// The whole file, if it is a GLB; else empty.
    pub(super) file: FileBytes,
    pub(super) container: Container,
    /// The JSON text as it was read.
    text: String,
    pub(super) root: Root,
    pub(super) resources: Resources,
    pub(super) buffer_sources: Vec<BufferSource>,
    pub(super) edits: Edits,
    /// The number of new bytes that came from compressed meshes.
    pub(super) decompressed_bytes: usize,
    memory_limit: MemoryLimit,
    /// The most elements of an accessor with a buffer view.
    pub(super) backed_count: OnceLock<usize>,
    primitive_texts: OnceLock<Vec<Vec<Box<RawValue>>>>,
    warnings: Vec<String>,
}

/// The source of a buffer's bytes.
#[derive(Debug)]
pub(super) enum BufferSource {
    /// The GLB's binary chunk.
    Chunk,
    /// A file.
    File(Arc<ResourceFile>),
    /// A `data:` URI, decoded.
    Data(Vec<u8>),
    /// Decompressed bytes of a buffer that had none.
    #[cfg_attr(not(feature = "meshopt"), expect(dead_code, reason = "only meshopt fills buffers"))]
    Decoded(Vec<u8>),
    /// None; the clause says why, and what to do.
    Absent(&'static str),
}

/// Edits of the JSON, as the new text of elements by their index, and new bytes.
#[derive(Debug, Default)]
pub(super) struct Edits {
    pub primitives: BTreeMap<(usize, usize), String>,
    pub accessors: BTreeMap<usize, String>,
    pub views: BTreeMap<usize, String>,
    pub buffers: BTreeMap<usize, String>,
    pub removed_extensions: Vec<&'static str>,
    pub required_extensions: Vec<&'static str>,
    pub new_accessors: Vec<String>,
    pub asset: Option<String>,
    /// Edited elements of `nodes`, `skins` and `animations`.
    pub scene: BTreeMap<&'static str, BTreeMap<usize, String>>,
    /// Accessors that primitives referred to before they were edited.
    pub formerly_referenced: BTreeSet<usize>,
    /// Whether a warning about unused data that stays has been given.
    pub is_unused_data_reported: bool,
    pub new_views: Vec<NewView>,
    /// The number of bytes in all new views.
    pub new_byte_count: usize,
}

/// A new buffer view and its bytes.
#[derive(Debug)]
pub(super) struct NewView {
    pub bytes: Vec<u8>,
    pub stride: Option<usize>,
    pub target: Option<Target>,
}

impl Document {
    /// Reads a `.glb` or `.gltf` file and the buffers that it refers to. The first bytes decide between the two formats.
    ///
    /// Errors: a file that cannot be read, or is not valid glTF; a reference to an element that does not exist.
    pub fn open(path: &Path, options: &LoadOptions) -> Result<Self, Error> {
        Self::open_with(path, options, FileAccess::default())
    }

    /// As [`Document::open`], with files mapped where the system can: large files are not copied, and parts that are not needed are
    /// not read.
    ///
    /// # Safety
    /// Until the document is dropped, no process may write into its files or shorten them. A process that shortens a file ends this
    /// one by a signal (SIGBUS on Unix); one that writes into a file changes bytes that Rust takes for constant.
    #[expect(unsafe_code, reason = "the caller vouches for other processes")]
    pub unsafe fn open_mapped(path: &Path, options: &LoadOptions) -> Result<Self, Error> {
        // SAFETY: the caller makes the promise that `mapped` asks for.
        Self::open_with(path, options, unsafe { FileAccess::mapped() })
    }

    fn open_with(path: &Path, options: &LoadOptions, access: FileAccess) -> Result<Self, Error> {
        let failed = |source| Error::Read { file: path.to_owned(), source };
        let input = paths::readable(path)?;
        let bytes = access.open(&input).map_err(failed)?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let name = path.display().to_string();
        let mut document = Self::from_file(&name, bytes, Some(folder), options, access)?;
        document.input = Some(input);
        Ok(document)
    }

    /// Reads a document from memory.
    ///
    /// `name` stands for the file in messages. `base` is the folder of external files; without it, buffers must be embedded, and
    /// references to image files are kept as they are. Errors: as [`Document::open`].
    pub fn from_bytes(
        name: &str,
        bytes: Vec<u8>,
        base: Option<&Path>,
        options: &LoadOptions,
    ) -> Result<Self, Error> {
        Self::from_file(name, FileBytes::Read(bytes), base, options, FileAccess::default())
    }

    fn from_file(
        name: &str,
        file: FileBytes,
        base: Option<&Path>,
        options: &LoadOptions,
        access: FileAccess,
    ) -> Result<Self, Error> {
        let resources = Resources::new(base, options.allow_outside, access)
            .map_err(|source| Error::Read { file: base.unwrap_or(Path::new("")).to_owned(), source })?;
        Self::parse(name, file, resources, options.memory_limit).map_err(|fault| fault.in_file(name))
    }

    fn parse(
        name: &str,
        mut file: FileBytes,
        mut resources: Resources,
        memory_limit: MemoryLimit,
    ) -> Result<Self, Fault> {
        let container = Container::parse(&file)?;
        let text = String::from_utf8(file[container.json.clone()].to_vec()).map_err(|error| {
            Fault::invalid("", format!("the JSON is not UTF-8: {error}; export the file again"))
        })?;
        if !container.is_glb {
            file = FileBytes::Read(Vec::new());
        }
        let root = parse_root(&text)?;
        references::check(&text)?;
        let chunk = container.bin.clone().map(|range| &file[range]);
        let buffer_sources = root
            .buffers
            .iter()
            .enumerate()
            .map(|(i, buffer)| load_buffer(i, buffer, chunk, &mut resources))
            .collect::<Result<_, _>>()?;
        let warnings = image_warnings(&root, &resources);
        let document = Self {
            name: name.to_owned(),
            input: None,
            file,
            container,
            text,
            root,
            resources,
            buffer_sources,
            edits: Edits::default(),
            decompressed_bytes: 0,
            memory_limit,
            backed_count: OnceLock::new(),
            primitive_texts: OnceLock::new(),
            warnings,
        };
        document.check_primitive_count()?;
        Ok(document)
    }

    /// Checks that the primitives do not need more memory than the limit.
    fn check_primitive_count(&self) -> Result<(), Fault> {
        let count: usize = self.root.meshes.iter().map(|mesh| mesh.primitives.len()).sum();
        let limit = self.memory_limit();
        if count.saturating_mul(memory_limit::BYTES_PER_PRIMITIVE) <= limit {
            return Ok(());
        }
        Err(Fault::unsupported(
            "meshes",
            memory_limit::exceeded(&format!("has {count} primitives, which need"), limit),
        ))
    }

    /// The most bytes that may be computed for a document of this size, or decompressed from it.
    pub(super) fn memory_limit(&self) -> usize {
        let buffers = self.buffer_sources.iter();
        let embedded = buffers.map(|source| match source {
            BufferSource::Chunk | BufferSource::Absent(_) => [0, 0],
            BufferSource::File(file) => [file.bytes.len(), 0],
            BufferSource::Data(bytes) => [bytes.len(), 0],
            BufferSource::Decoded(bytes) => [0, bytes.len()],
        });
        let start = [self.file.len().max(self.text.len()), self.decompressed_bytes];
        let [read, decompressed] = embedded.fold(start, |sum, bytes| [sum[0] + bytes[0], sum[1] + bytes[1]]);
        self.memory_limit.for_sizes(read, decompressed)
    }

    /// The name of the document in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Problems that are not errors, such as missing images: one sentence each.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The meshes, edits included.
    pub fn meshes(&self) -> &[schema::Mesh] {
        &self.root.meshes
    }

    /// The materials.
    pub fn materials(&self) -> &[schema::Material] {
        &self.root.materials
    }

    /// The accessors, new ones included.
    pub fn accessors(&self) -> &[schema::Accessor] {
        &self.root.accessors
    }

    /// Appends an accessor with new buffer views. Returns its index.
    ///
    /// Panics if `new.elements.bytes` does not have the length of `count` elements.
    pub fn push_accessor(&mut self, new: NewAccessor) -> usize {
        let like = new.like.and_then(|index| self.root.accessors.get(index)).cloned();
        let bounds = new.bounds.then(|| new.elements.bounds()).flatten();
        let stored = self.store(new);
        self.edits.new_accessors.push(stored.to_json(bounds, like.as_ref()));
        if let Some(backed) = self.backed_count.get_mut() {
            *backed = (*backed).max(stored.count);
        }
        self.root.accessors.push(stored);
        self.root.accessors.len() - 1
    }

    /// As [`Document::push_accessor`], unless the accessor `old`, which `new` would replace, has the same elements: then `old` is
    /// kept. A second run with the same result thus stores nothing new.
    pub(super) fn push_in_place_of(&mut self, old: Option<usize>, new: NewAccessor) -> usize {
        let is_same = |&old: &usize| self.elements(old).is_ok_and(|elements| elements == new.elements);
        match old.filter(is_same) {
            Some(old) => old,
            None => self.push_accessor(new),
        }
    }

    /// Stores the elements of `new` in new buffer views.
    fn store(&mut self, new: NewAccessor) -> schema::Accessor {
        let elements = new.elements;
        let size = elements.element_size();
        assert_eq!(elements.bytes.len(), elements.count * size, "bytes are not whole elements");
        let places = new.sparse.then(|| elements.sparse_indices()).flatten();
        let (buffer_view, sparse) = match places {
            Some(places) if places.is_empty() => (None, None),
            Some(places) => (None, Some(Box::new(self.push_sparse(&elements, &places)))),
            None => {
                let stride = new.target.stride(size);
                (Some(self.push_view(elements.bytes, size, stride, Some(new.target))), None)
            }
        };
        schema::Accessor {
            buffer_view,
            byte_offset: 0,
            component_type: elements.component_type,
            normalized: elements.normalized,
            count: elements.count,
            element_type: elements.element_type,
            sparse,
            name: None,
            extras: None,
            extensions: None,
        }
    }

    fn push_sparse(&mut self, elements: &Elements, places: &[u32]) -> schema::Sparse {
        let size = elements.element_size();
        let indices: Vec<_> = places.iter().flat_map(|place| place.to_le_bytes()).collect();
        let values: Vec<_> = places
            .iter()
            .flat_map(|&place| &elements.bytes[place as usize * size..(place as usize + 1) * size])
            .copied()
            .collect();
        let indices = schema::SparseIndices {
            buffer_view: self.push_view(indices, 4, 4, None),
            byte_offset: 0,
            component_type: ComponentType::U32,
        };
        let values =
            schema::SparseValues { buffer_view: self.push_view(values, size, size, None), byte_offset: 0 };
        schema::Sparse { count: places.len(), indices, values }
    }

    /// Appends a buffer view of elements of `size` bytes, `stride` bytes apart. Returns its index.
    pub(super) fn push_view(
        &mut self,
        bytes: Vec<u8>,
        size: usize,
        stride: usize,
        target: Option<Target>,
    ) -> usize {
        let view = if stride == size {
            NewView { bytes, stride: None, target }
        } else {
            let mut spread = vec![0; bytes.len() / size * stride];
            for (slot, element) in spread.chunks_exact_mut(stride).zip(bytes.chunks_exact(size)) {
                slot[..size].copy_from_slice(element);
            }
            NewView { bytes: spread, stride: Some(stride), target }
        };
        self.edits.new_byte_count += view.bytes.len();
        self.edits.new_views.push(view);
        self.root.buffer_views.len() + self.edits.new_views.len() - 1
    }

    /// Edits a primitive.
    ///
    /// The map holds the members `attributes`, `indices`, `material`, `mode` and `targets`. Other members, and those that `edit` leaves
    /// equal, keep their spelling. Errors: no such primitive; a result that is not a primitive.
    pub fn edit_primitive(
        &mut self,
        mesh: usize,
        primitive: usize,
        edit: impl FnOnce(&mut Map<String, Value>),
    ) -> Result<(), Error> {
        let at = || format!("meshes[{mesh}].primitives[{primitive}]");
        let text = self
            .primitive_text(mesh, primitive)
            .ok_or_else(|| self.invalid(at(), "does not exist; name one of the document"))?;
        let edited = edited_primitive(text, edit).map_err(|error| self.invalid(at(), error.to_string()))?;
        self.replace_primitive(mesh, primitive, edited)
            .map_err(|error| self.invalid(at(), format!("the edit is not a primitive: {error}")))
    }

    /// Declares extensions that readers must support, unless they are declared already.
    pub(super) fn require_extensions(&mut self, names: impl IntoIterator<Item = &'static str>) {
        for name in names {
            if !self.edits.required_extensions.contains(&name) {
                self.edits.required_extensions.push(name);
            }
        }
    }

    /// The JSON of a primitive, edits included.
    pub(super) fn primitive_text(&self, mesh: usize, primitive: usize) -> Option<&str> {
        if let Some(edited) = self.edits.primitives.get(&(mesh, primitive)) {
            return Some(edited);
        }
        let texts = self.primitive_texts.get_or_init(|| split_primitives(self.text()));
        Some(texts.get(mesh)?.get(primitive)?.get())
    }

    /// Sets the JSON of an existing primitive, unless it is the same.
    pub(super) fn replace_primitive(
        &mut self,
        mesh: usize,
        primitive: usize,
        text: String,
    ) -> serde_json::Result<()> {
        if self.primitive_text(mesh, primitive) == Some(&text) {
            return Ok(());
        }
        let replaced: schema::Primitive = serde_json::from_str(&text)?;
        let replaced = std::mem::replace(&mut self.root.meshes[mesh].primitives[primitive], replaced);
        let attributes = replaced.targets.iter().chain([&replaced.attributes]).flat_map(BTreeMap::values);
        self.edits.formerly_referenced.extend(attributes.chain(&replaced.indices));
        self.edits.primitives.insert((mesh, primitive), text);
        Ok(())
    }

    /// Whether there are edits.
    pub fn is_changed(&self) -> bool {
        let Edits {
            primitives,
            accessors,
            views,
            buffers,
            removed_extensions,
            new_accessors,
            asset,
            scene,
            ..
        } = &self.edits;
        !(primitives.is_empty()
            && accessors.is_empty()
            && views.is_empty()
            && buffers.is_empty()
            && removed_extensions.is_empty()
            && new_accessors.is_empty()
            && asset.is_none()
            && scene.is_empty())
    }

    /// The JSON text as it was read.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// The JSON text as it was read, parsed as another type.
    pub(super) fn parsed<T: DeserializeOwned>(&self) -> Result<T, Fault> {
        let mut parser = serde_json::Deserializer::from_str(&self.text);
        serde_path_to_error::deserialize(&mut parser).map_err(json_fault)
    }

    /// The bytes of a buffer view, and its stride. `at` is the JSON path that refers to it.
    pub(super) fn view(&self, index: usize, at: &str) -> Result<(&[u8], Option<usize>), Fault> {
        let views = &self.root.buffer_views;
        if let Some(new) = index.checked_sub(views.len()).and_then(|new| self.edits.new_views.get(new)) {
            return Ok((&new.bytes, new.stride));
        }
        let view = views.get(index).ok_or_else(|| {
            let problem = format!("buffer view {index} does not exist: there are {}", views.len());
            Fault::invalid(at, format!("{problem}; export the file again"))
        })?;
        let at = format!("bufferViews[{index}]");
        let bytes = self.buffer_range(view.buffer, view.byte_offset, view.byte_length, &at)?;
        Ok((bytes, view.byte_stride))
    }

    /// A range of a buffer. `at` is the JSON path that refers to it.
    pub(super) fn buffer_range(
        &self,
        buffer: usize,
        offset: usize,
        length: usize,
        at: &str,
    ) -> Result<&[u8], Fault> {
        let bytes = self.buffer(buffer, &format!("{at}.buffer"))?;
        offset.checked_add(length).and_then(|end| bytes.get(offset..end)).ok_or_else(|| {
            let problem = format!(
                "{length} bytes from byte {offset} on do not fit the buffer of {} bytes",
                bytes.len()
            );
            Fault::invalid(at, format!("{problem}; export the file again"))
        })
    }

    /// The bytes of a buffer. `at` is the JSON path that refers to it.
    pub(super) fn buffer(&self, index: usize, at: &str) -> Result<&[u8], Fault> {
        let (Some(buffer), Some(store)) = (self.root.buffers.get(index), self.buffer_sources.get(index))
        else {
            let problem = format!("buffer {index} does not exist: there are {}", self.root.buffers.len());
            return Err(Fault::invalid(at, format!("{problem}; export the file again")));
        };
        let bytes = match store {
            BufferSource::Chunk => &self.file[self.container.bin.clone().unwrap_or_default()],
            BufferSource::File(file) => &file.bytes,
            BufferSource::Data(bytes) | BufferSource::Decoded(bytes) => bytes,
            BufferSource::Absent(why) => return Err(Fault::resource(format!("buffers[{index}]"), *why)),
        };
        // A source may be longer than its buffer: the GLB's chunk is padded.
        Ok(&bytes[..buffer.byte_length.min(bytes.len())])
    }

    /// The error [`Error::Invalid`] about the JSON path `at`.
    pub fn invalid(&self, at: impl Into<String>, problem: impl Into<String>) -> Error {
        Fault::invalid(at, problem).in_file(&self.name)
    }

    /// The error [`Error::Mesh`] about the primitive at the JSON path `at`.
    pub fn mesh_error(&self, at: impl Into<String>, source: darboux::Error) -> Error {
        Error::Mesh { file: self.name.clone(), at: at.into(), source }
    }
}

fn parse_root(text: &str) -> Result<Root, Fault> {
    // Tracking the path of a failure costs time, so only text that fails is parsed again for it.
    let parsed: Result<Root, _> = serde_json::from_str(text);
    let version = match &parsed {
        Ok(root) => Some(root.asset.version.clone()),
        Err(_) => serde_json::from_str(text).ok().map(|probe: Probe| probe.asset.version),
    };
    if let Some(version) = version.filter(|version| !version.starts_with("2.")) {
        let problem = format!("is {version:?}; convert the file to glTF 2.0");
        return Err(Fault::invalid("asset.version", problem));
    }
    parsed.or_else(|_| {
        let mut parser = serde_json::Deserializer::from_str(text);
        let root = serde_path_to_error::deserialize(&mut parser).map_err(json_fault)?;
        parser
            .end()
            .map_err(|error| Fault::invalid("", format!("is not JSON: {error}; export the file again")))?;
        Ok(root)
    })
}

fn json_fault(error: serde_path_to_error::Error<serde_json::Error>) -> Fault {
    let at = error.path().to_string();
    let problem = error.inner();
    if problem.is_data() {
        Fault::invalid(
            if at == "." { String::new() } else { at },
            format!("{problem}; export the file again"),
        )
    } else {
        Fault::invalid("", format!("is not JSON: {problem}; export the file again"))
    }
}

fn load_buffer(
    index: usize,
    buffer: &schema::Buffer,
    chunk: Option<&[u8]>,
    resources: &mut Resources,
) -> Result<BufferSource, Fault> {
    let at = || format!("buffers[{index}].uri");
    let store = match buffer.uri.as_deref().map(|uri| resources.resolve(uri)) {
        None if index == 0 && chunk.is_some() => BufferSource::Chunk,
        None => return Ok(BufferSource::Absent("has no bytes; export the file again")),
        Some(Ok(UriTarget::Remote)) => {
            return Ok(BufferSource::Absent("is on another machine; download it and refer to the file"));
        }
        Some(Ok(UriTarget::Data(data))) => {
            BufferSource::Data(decode_data_uri(data).map_err(|problem| Fault::invalid(at(), problem))?)
        }
        Some(Ok(UriTarget::File(located))) => {
            let file = resources.open(&located);
            BufferSource::File(
                file.map_err(|error| Fault::resource(at(), format!("cannot be read: {error}")))?,
            )
        }
        Some(Err(problem)) => return Err(Fault::resource(at(), problem)),
    };
    let available = match &store {
        BufferSource::File(file) => file.bytes.len(),
        BufferSource::Data(bytes) => bytes.len(),
        _ => chunk.unwrap_or_default().len(),
    };
    if buffer.byte_length > available {
        let problem =
            format!("is {} but there are {available} bytes; export the file again", buffer.byte_length);
        return Err(Fault::invalid(format!("buffers[{index}].byteLength"), problem));
    }
    Ok(store)
}

fn image_warnings(root: &Root, resources: &Resources) -> Vec<String> {
    let uris = root.images.iter().enumerate().filter_map(|(i, image)| Some((i, image.uri.as_deref()?)));
    uris.filter_map(|(i, uri)| {
        let problem = resources.resolve(uri).err()?;
        Some(format!("images[{i}].uri: {problem}; the reference is kept"))
    })
    .collect()
}

/// The JSON text of every primitive of every mesh.
fn split_primitives(text: &str) -> Vec<Vec<Box<RawValue>>> {
    #[derive(Deserialize)]
    struct Meshes {
        #[serde(default)]
        meshes: Vec<Primitives>,
    }
    #[derive(Deserialize)]
    struct Primitives {
        primitives: Vec<Box<RawValue>>,
    }
    let parsed: serde_json::Result<Meshes> = serde_json::from_str(text);
    // The same text was parsed more strictly when the document was read.
    let meshes = parsed.map(|parsed| parsed.meshes).unwrap_or_default();
    meshes.into_iter().map(|mesh| mesh.primitives).collect()
}

fn edited_primitive(text: &str, edit: impl FnOnce(&mut Map<String, Value>)) -> serde_json::Result<String> {
    const UNDERSTOOD: [&str; 5] = ["attributes", "indices", "material", "mode", "targets"];
    let mut before = Map::new();
    for key in UNDERSTOOD {
        if let Some(value) = json_text::member(text, key)? {
            before.insert(key.to_owned(), serde_json::from_str(value)?);
        }
    }
    let mut after = before.clone();
    edit(&mut after);
    let mut text = text.to_owned();
    for key in before.keys().filter(|key| !after.contains_key(*key)) {
        text = json_text::set_member(&text, key, None)?;
    }
    for (key, value) in after.iter().filter(|&(key, value)| before.get(key) != Some(value)) {
        text = json_text::set_member(&text, key, Some(&value.to_string()))?;
    }
    Ok(text)
}

//! The layout of an output: the destination of every buffer's bytes, and the JSON with the new offsets.
//!
//! A *binary output* is the binary chunk of a GLB, or a new file beside a `.gltf`. A GLB has one, to which all buffers are moved; a
//! `.gltf` has one for each buffer that was in memory only. Buffer views move with their buffers.

use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;

use serde_json::value::RawValue;

use super::buffers::BufferSource;
use super::document::Document;
use super::edits::{ImageFile, NewView};
use super::elements::Target;
use super::json_text::{edit_array, keys, member, quoted, set_member};
use super::resources::{UriTarget, encode_data_uri, image_type};
use super::schema::Buffer;
use super::segments::Segment;
use super::unused_data::UnusedData;
use crate::error::ContentError;

/// The segments of a binary chunk, or of a new file.
#[derive(Debug, Default)]
pub struct BinaryOutput<'a> {
    pub segments: Vec<Segment<'a>>,
    length: usize,
}

impl<'a> BinaryOutput<'a> {
    /// Appends bytes at the next multiple of four. Returns their offset.
    fn push(&mut self, bytes: Segment<'a>) -> usize {
        let offset = self.align();
        self.append(bytes);
        offset
    }

    /// Appends the parts of a buffer, the first at the next multiple of four. Returns its offset.
    fn push_parts(&mut self, parts: &[&'a [u8]]) -> usize {
        let offset = self.align();
        parts.iter().for_each(|part| self.append(Segment::Borrowed(part)));
        offset
    }

    /// Pads to a multiple of four. Returns the length.
    fn align(&mut self) -> usize {
        let padding = self.length.next_multiple_of(4) - self.length;
        self.append(Segment::Borrowed(&[0; 4][..padding]));
        self.length
    }

    fn append(&mut self, bytes: Segment<'a>) {
        self.length += bytes.len();
        self.segments.push(bytes);
    }
}

/// A buffer of the output.
#[derive(Debug)]
struct OutputBuffer {
    /// The input buffer whose JSON is kept.
    source: Option<usize>,
    content: BufferContent,
}

#[derive(Debug)]
enum BufferContent {
    /// The bytes stay where they are.
    Kept,
    /// The binary output with this index.
    Binary(usize),
    /// A `data:` URI.
    DataUri,
}

/// The start of an input buffer in an output buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct BufferPlace {
    output_buffer: usize,
    offset: usize,
}

/// An image file that is embedded in the GLB.
#[derive(Debug)]
struct EmbeddedImage {
    index: usize,
    view: usize,
    media_type: String,
}

/// The URIs of the files that are written beside a `.gltf`; none for a GLB.
#[derive(Debug, Default)]
pub struct FileUris {
    /// Those of the binary outputs.
    pub binaries: Vec<String>,
    /// Those of files that were copied under another name, by their paths.
    pub renamed: HashMap<PathBuf, String>,
    /// Those of images with new content, by their indices.
    pub images: BTreeMap<usize, String>,
}

/// The layout of an output.
#[derive(Debug)]
pub struct OutputLayout<'a> {
    document: &'a Document,
    pub binaries: Vec<BinaryOutput<'a>>,
    output_buffers: Vec<OutputBuffer>,
    /// The new start of each input buffer.
    places: Vec<BufferPlace>,
    /// The data that is not written.
    pub unused_data: UnusedData,
    /// The JSON of the buffer views of new data and images.
    new_views: Vec<String>,
    images: Vec<EmbeddedImage>,
}

impl<'a> OutputLayout<'a> {
    /// The layout of a GLB: all buffers in the binary chunk, images in buffer views.
    ///
    /// Buffers after the first that have extras or extensions become `data:` URIs, so that these are kept. Buffers without bytes keep
    /// their JSON and follow the binary chunk.
    pub fn glb(document: &'a Document) -> Result<Self, ContentError> {
        let mut layout = Self::empty(document)?;
        let texts = document.buffer_texts().map_err(broken)?;
        let mut binary = BinaryOutput::default();
        let mut source = None;
        let mut aside = Vec::new();
        let mut merged: HashMap<(&PathBuf, usize), BufferPlace> = HashMap::new();
        for (i, buffer) in document.root.buffers.iter().enumerate() {
            if let BufferSource::Absent(_) = document.buffer_sources[i] {
                if !layout.unused_data.has_buffer(i) {
                    aside.push(OutputBuffer { source: Some(i), content: BufferContent::Kept });
                }
                continue;
            }
            let bytes = document.buffer(i, "buffers")?;
            let kept = layout.unused_data.kept(i, bytes);
            let is_mergeable = source.is_none() || kept.is_empty() || is_plain(&texts[i]).map_err(broken)?;
            if !is_mergeable {
                aside.push(OutputBuffer { source: Some(i), content: BufferContent::DataUri });
                continue;
            }
            source.get_or_insert(i);
            let mut push = || BufferPlace { output_buffer: 0, offset: binary.push_parts(&kept) };
            layout.places[i] = match &document.buffer_sources[i] {
                BufferSource::File(file) if kept == [bytes] => {
                    *merged.entry((&file.located.path, buffer.byte_length)).or_insert_with(push)
                }
                _ => push(),
            };
        }
        layout.push_new_views(&mut binary, 0);
        layout.push_images(&mut binary)?;
        if source.is_some() || binary.length > 0 {
            layout.output_buffers.push(OutputBuffer { source, content: BufferContent::Binary(0) });
            layout.binaries.push(binary);
        }
        for output_buffer in aside {
            let place = BufferPlace { output_buffer: layout.output_buffers.len(), offset: 0 };
            layout.places[output_buffer.source.unwrap_or_default()] = place;
            layout.output_buffers.push(output_buffer);
        }
        Ok(layout)
    }

    /// The layout of a `.gltf`. Buffers keep their files; those that were in memory only, or in files that an earlier run made, get new
    /// files. New bytes are appended to the first of these.
    pub fn gltf(document: &'a Document) -> Result<Self, ContentError> {
        let mut layout = Self::empty(document)?;
        for (i, store) in
            document.buffer_sources.iter().enumerate().filter(|(i, _)| !layout.unused_data.has_buffer(*i))
        {
            let has_home = matches!(store, BufferSource::Chunk | BufferSource::Decoded(_))
                || document.replaced_file(i).is_some();
            let content =
                if has_home { BufferContent::Binary(layout.binaries.len()) } else { BufferContent::Kept };
            if has_home {
                let mut binary = BinaryOutput::default();
                binary.push_parts(&layout.unused_data.kept(i, document.buffer(i, "buffers")?));
                layout.binaries.push(binary);
            }
            layout.places[i] = BufferPlace { output_buffer: layout.output_buffers.len(), offset: 0 };
            layout.output_buffers.push(OutputBuffer { source: Some(i), content });
        }
        if document.edits.new_views.is_empty() {
            return Ok(layout);
        }
        let first = layout
            .output_buffers
            .iter()
            .position(|output_buffer| matches!(output_buffer.content, BufferContent::Binary(_)));
        let output_buffer = first.unwrap_or_else(|| {
            layout
                .output_buffers
                .push(OutputBuffer { source: None, content: BufferContent::Binary(layout.binaries.len()) });
            layout.binaries.push(BinaryOutput::default());
            layout.output_buffers.len() - 1
        });
        let mut binary = std::mem::take(&mut layout.binaries[0]);
        layout.push_new_views(&mut binary, output_buffer);
        layout.binaries[0] = binary;
        Ok(layout)
    }

    fn empty(document: &'a Document) -> Result<Self, ContentError> {
        let unused_data = UnusedData::of(document).map_err(broken)?;
        let places = vec![BufferPlace { output_buffer: 0, offset: 0 }; document.root.buffers.len()];
        let (binaries, output_buffers, new_views, images) = Default::default();
        Ok(Self { document, binaries, output_buffers, places, unused_data, new_views, images })
    }

    fn push_new_views(&mut self, binary: &mut BinaryOutput<'a>, output_buffer: usize) {
        for (place, NewView { bytes, stride, target }) in self.document.edits.new_views.iter().enumerate() {
            if self.unused_data.has_new_view(self.document, place) {
                self.new_views.push("null".to_owned());
                continue;
            }
            let (offset, length) = (binary.push(Segment::Borrowed(bytes)), bytes.len());
            let stride = stride.map(|stride| format!(",\"byteStride\":{stride}")).unwrap_or_default();
            let target = target.and_then(Target::code);
            let target = target.map(|code| format!(",\"target\":{code}")).unwrap_or_default();
            self.new_views.push(format!(
                "{{\"buffer\":{output_buffer},\"byteOffset\":{offset},\"byteLength\":{length}{stride}{target}}}"
            ));
        }
    }

    /// Embeds image files. References to images that are missing, remote or of unknown type are kept.
    fn push_images(&mut self, binary: &mut BinaryOutput<'a>) -> Result<(), ContentError> {
        let document = self.document;
        let mut embedded: HashMap<PathBuf, Option<(usize, &str)>> = HashMap::new();
        for (index, image) in document.root.images.iter().enumerate() {
            if let Some(ImageFile { bytes, media_type, .. }) = document.edits.image_files.get(&index) {
                let view = self.push_image(binary, Segment::Borrowed(bytes));
                self.images.push(EmbeddedImage { index, view, media_type: media_type.clone() });
                continue;
            }
            let reference = image.uri.as_deref().map(|uri| document.resources.resolve(uri));
            let Some(Ok(UriTarget::File(located))) = reference else { continue };
            let stored = match embedded.get(&located.path) {
                Some(stored) => *stored,
                None => {
                    let bytes = document.resources.bytes(&located.path).map_err(|error| {
                        ContentError::resource(
                            format!("images[{index}].uri"),
                            format!("cannot be read: {error}"),
                        )
                    })?;
                    let kind = image_type(&bytes);
                    let stored = kind.map(|kind| (self.push_image(binary, Segment::File(bytes)), kind));
                    embedded.insert(located.path, stored);
                    stored
                }
            };
            if let Some((view, kind)) = stored {
                let media_type = image.mime_type.clone().unwrap_or_else(|| kind.to_owned());
                self.images.push(EmbeddedImage { index, view, media_type });
            }
        }
        Ok(())
    }

    /// Appends an image. Returns the index of its buffer view.
    fn push_image(&mut self, binary: &mut BinaryOutput<'a>, bytes: Segment<'a>) -> usize {
        let length = bytes.len();
        let offset = binary.push(bytes);
        self.new_views.push(format!("{{\"buffer\":0,\"byteOffset\":{offset},\"byteLength\":{length}}}"));
        self.document.root.buffer_views.len() + self.new_views.len() - 1
    }

    /// The JSON of the output.
    pub fn json(&self, uris: &FileUris) -> Result<String, ContentError> {
        let edits = &self.document.edits;
        let mut root = self.document.text().to_owned();
        let mut set =
            |key: &str, edit: &dyn Fn(&str) -> serde_json::Result<String>| -> serde_json::Result<()> {
                let old = member(&root, key)?;
                let new = edit(old.unwrap_or("[]"))?;
                if new != old.unwrap_or("[]") {
                    root = set_member(&root, key, (new != "[]").then_some(&new))?;
                }
                Ok(())
            };
        (|| {
            set("asset", &|asset| Ok(edits.asset.clone().unwrap_or_else(|| asset.to_owned())))?;
            set("meshes", &|meshes| self.document.edited_meshes(meshes))?;
            for (key, edited, appended) in edits.edited_arrays() {
                set(key, &|elements| edit_array(elements, edited, appended))?;
            }
            set("accessors", &|accessors| edit_array(accessors, &edits.accessors, &edits.new_accessors))?;
            set("bufferViews", &|views| self.views(views))?;
            set("buffers", &|buffers| self.buffers(buffers, uris))?;
            set("images", &|images| self.images(images, uris))?;
            for key in ["extensionsUsed", "extensionsRequired"] {
                set(key, &|names| self.extensions(names))?;
            }
            Ok(())
        })()
        .and_then(|()| self.unused_data.cleared(root))
        .map_err(broken)
    }

    fn views(&self, views: &str) -> serde_json::Result<String> {
        let mut edited = self.document.edits.views.clone();
        let unmoved = |(i, place): (usize, &BufferPlace)| {
            *place == BufferPlace { output_buffer: i, offset: 0 } && !self.unused_data.has_unused_ranges(i)
        };
        if !self.places.iter().enumerate().all(unmoved) {
            let old: Vec<&RawValue> = serde_json::from_str(views)?;
            for (i, old) in old.iter().enumerate() {
                let text = edited.get(&i).map_or(old.get(), String::as_str);
                let moved = self.moved_view(text)?;
                if moved != old.get() {
                    edited.insert(i, moved);
                }
            }
        }
        edit_array(views, &edited, &self.new_views)
    }

    /// The JSON of a buffer view after the move, with every extension that refers to a buffer.
    fn moved_view(&self, view: &str) -> serde_json::Result<String> {
        let mut moved = self.moved(view)?;
        if let Some(extensions) = member(view, "extensions")? {
            let mut moved_extensions = extensions.to_owned();
            for name in keys(extensions)? {
                let extension = member(extensions, &name)?.unwrap_or_default();
                if extension.starts_with('{') {
                    moved_extensions = set_member(&moved_extensions, &name, Some(&self.moved(extension)?))?;
                }
            }
            moved = set_member(&moved, "extensions", Some(&moved_extensions))?;
        }
        Ok(moved)
    }

    /// The JSON of an object with `buffer` and `byteOffset` after the move.
    fn moved(&self, range: &str) -> serde_json::Result<String> {
        let number = |key| Ok(member(range, key)?.and_then(|text| text.parse::<usize>().ok()));
        let Some(buffer) = number("buffer")? else { return Ok(range.to_owned()) };
        let Some(&BufferPlace { output_buffer, offset }) = self.places.get(buffer) else {
            return Ok(range.to_owned());
        };
        let start = number("byteOffset")?.unwrap_or(0);
        let is_rewritten = self
            .output_buffers
            .get(output_buffer)
            .is_some_and(|output_buffer| matches!(output_buffer.content, BufferContent::Binary(_)));
        let moved_start = if is_rewritten { self.unused_data.moved(buffer, start) } else { start };
        let moved_start = moved_start.saturating_add(offset);
        let mut moved = range.to_owned();
        if output_buffer != buffer {
            moved = set_member(&moved, "buffer", Some(&output_buffer.to_string()))?;
        }
        if moved_start != start {
            moved = set_member(&moved, "byteOffset", Some(&moved_start.to_string()))?;
        }
        Ok(moved)
    }

    fn buffers(&self, buffers: &str, uris: &FileUris) -> serde_json::Result<String> {
        let old: Vec<&RawValue> = serde_json::from_str(buffers)?;
        let texts = self.document.buffer_texts()?;
        let mut written = Vec::with_capacity(self.output_buffers.len());
        for output_buffer in &self.output_buffers {
            written.push(self.buffer(output_buffer, &texts, uris)?);
        }
        let in_place = self
            .output_buffers
            .iter()
            .take(old.len())
            .enumerate()
            .all(|(i, output_buffer)| output_buffer.source == Some(i));
        if !in_place || written.len() < old.len() {
            return Ok(format!("[{}]", written.join(",")));
        }
        let appended = written.split_off(old.len());
        let changed = written.into_iter().enumerate().filter(|(i, text)| text != old[*i].get());
        edit_array(buffers, &changed.collect(), &appended)
    }

    fn buffer(
        &self,
        output_buffer: &OutputBuffer,
        texts: &[String],
        uris: &FileUris,
    ) -> serde_json::Result<String> {
        let new_file = format!("{{\"name\":{}}}", Buffer::NAME_FOR_NEW_DATA);
        let new = if uris.binaries.is_empty() { "{}" } else { &new_file };
        let text = output_buffer.source.map_or(new, |source| texts[source].as_str());
        match (&output_buffer.content, output_buffer.source) {
            (BufferContent::Binary(binary), _) => {
                let length = self.binaries[*binary].length;
                let before =
                    output_buffer.source.map(|source| self.document.root.buffers[source].byte_length);
                let text = if before == Some(length) {
                    text.to_owned()
                } else {
                    set_member(text, "byteLength", Some(&length.to_string()))?
                };
                set_member(&text, "uri", uris.binaries.get(*binary).map(|uri| quoted(uri)).as_deref())
            }
            (BufferContent::DataUri, Some(source)) => {
                let bytes = self.document.buffer(source, "").unwrap_or_default();
                set_member(text, "uri", Some(&quoted(&encode_data_uri("application/octet-stream", bytes))))
            }
            (_, source) => match source.map(|source| &self.document.buffer_sources[source]) {
                Some(BufferSource::File(file)) => match uris.renamed.get(&file.located.path) {
                    Some(uri) => set_member(text, "uri", Some(&quoted(uri))),
                    None => Ok(text.to_owned()),
                },
                _ => Ok(text.to_owned()),
            },
        }
    }

    fn images(&self, images: &str, uris: &FileUris) -> serde_json::Result<String> {
        let FileUris { renamed, images: new_files, .. } = uris;
        let mut edited = self.document.edits.images.clone();
        if self.images.is_empty() && renamed.is_empty() && edited.is_empty() {
            return Ok(images.to_owned());
        }
        let old: Vec<&RawValue> = serde_json::from_str(images)?;
        let text = |edited: &BTreeMap<usize, String>, index: usize| {
            edited.get(&index).cloned().unwrap_or_else(|| old[index].get().to_owned())
        };
        for EmbeddedImage { index, view, media_type } in &self.images {
            let text = set_member(&text(&edited, *index), "uri", None)?;
            let text = set_member(&text, "mimeType", Some(&quoted(media_type)))?;
            edited.insert(*index, set_member(&text, "bufferView", Some(&view.to_string()))?);
        }
        for (&index, uri) in new_files {
            edited.insert(index, set_member(&text(&edited, index), "uri", Some(&quoted(uri)))?);
        }
        for (index, image) in self.document.root.images.iter().enumerate().filter(|_| !renamed.is_empty()) {
            let reference = image.uri.as_deref().map(|uri| self.document.resources.resolve(uri));
            let Some(Ok(UriTarget::File(located))) = reference else { continue };
            let uri = renamed.get(&located.path).filter(|_| !new_files.contains_key(&index));
            if let Some(uri) = uri {
                edited.insert(index, set_member(&text(&edited, index), "uri", Some(&quoted(uri)))?);
            }
        }
        edit_array(images, &edited, &[])
    }

    fn extensions(&self, names: &str) -> serde_json::Result<String> {
        let edits = &self.document.edits;
        let (removed, required) = (&edits.removed_extensions, &edits.required_extensions);
        let old: Vec<String> = serde_json::from_str(names)?;
        let mut new: Vec<&str> = old.iter().map(String::as_str).collect();
        new.retain(|name| !removed.contains(name));
        new.extend(required.iter().filter(|name| !old.iter().any(|old| old == *name)));
        if new == old {
            return Ok(names.to_owned());
        }
        Ok(format!("[{}]", new.into_iter().map(quoted).collect::<Vec<_>>().join(",")))
    }
}

impl Document {
    /// The JSON array of meshes with edited primitives.
    pub(super) fn edited_meshes(&self, meshes: &str) -> serde_json::Result<String> {
        let mut by_mesh: BTreeMap<usize, BTreeMap<usize, String>> = BTreeMap::new();
        for (&(mesh, primitive), text) in &self.edits.primitives {
            by_mesh.entry(mesh).or_default().insert(primitive, text.clone());
        }
        let old: Vec<&RawValue> = serde_json::from_str(meshes)?;
        let mut edited = BTreeMap::new();
        for (mesh, primitives) in by_mesh {
            let text = old[mesh].get();
            let list = edit_array(member(text, "primitives")?.unwrap_or("[]"), &primitives, &[])?;
            edited.insert(mesh, set_member(text, "primitives", Some(&list))?);
        }
        edit_array(meshes, &edited, &[])
    }

    /// The JSON of every buffer, with edits.
    fn buffer_texts(&self) -> serde_json::Result<Vec<String>> {
        let array = member(self.text(), "buffers")?.unwrap_or("[]");
        let texts: Vec<&RawValue> = serde_json::from_str(array)?;
        let edited = &self.edits.buffers;
        let text =
            |(i, text): (usize, &&RawValue)| edited.get(&i).cloned().unwrap_or_else(|| text.get().to_owned());
        Ok(texts.iter().enumerate().map(text).collect())
    }
}

/// Whether a buffer can be merged into another without loss of JSON members.
fn is_plain(buffer: &str) -> serde_json::Result<bool> {
    Ok(keys(buffer)?.iter().all(|key| ["uri", "byteLength", "name"].contains(&key.as_str())))
}

fn broken(error: serde_json::Error) -> ContentError {
    ContentError::invalid("", format!("the JSON cannot be edited: {error}; export the file again"))
}

//! The layout of an output: the destination of every buffer's bytes, and the JSON with the new offsets.
//!
//! A *binary output* is the binary chunk of a GLB, or a new file beside a `.gltf`. A GLB has one, to which
//! all buffers are moved; a `.gltf` has one for each buffer that was in memory only. Buffer views move with
//! their buffers.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use crate::json::{Value, object};

use super::buffers::{BufferSource, ImageFile};
use super::document::Document;
use super::resources::{UriTarget, encode_data_uri, image_type};
use super::schema::{Buffer, BufferView};
use super::segments::Segment;
use super::unused_data::{UnusedData, merged};
use crate::error::{ContentError, system_reason};
use crate::json::{Part, TextLayout};

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
    /// A `data:` URI of the bytes of a buffer, which begin with the bytes of the source.
    DataUri { of: usize },
    /// One byte, which keeps the JSON of a buffer whose bytes are in another one over the same file.
    Placeholder,
}

/// The files that buffers read. Many buffers may read the same one, which is written once.
struct SharedFiles<'a> {
    document: &'a Document,
    by_path: HashMap<&'a PathBuf, SharedFile>,
}

struct SharedFile {
    /// The buffer that has most bytes of it.
    longest: usize,
    /// What is kept of it for all its buffers, ascending.
    ranges: Vec<Range<usize>>,
    place: SharedPlace,
}

/// Where the bytes of a file were written.
enum SharedPlace {
    None,
    Binary(Arc<[MovedRange]>),
    /// With this index among the buffers that follow the binary chunk.
    Aside(usize),
}

impl<'a> SharedFiles<'a> {
    fn of(document: &'a Document, unused_data: &UnusedData) -> Self {
        let mut by_path: HashMap<&PathBuf, SharedFile> = HashMap::new();
        let length = |buffer: usize| document.buffer(buffer, String::new).map_or(0, <[u8]>::len);
        for (buffer, store) in document.buffers.iter().enumerate() {
            let BufferSource::File(file) = store else { continue };
            let new = || SharedFile { longest: buffer, ranges: Vec::new(), place: SharedPlace::None };
            let shared = by_path.entry(&file.located.path).or_insert_with(new);
            shared.ranges.extend(unused_data.kept_ranges(buffer, length(buffer)));
            if length(buffer) > length(shared.longest) {
                shared.longest = buffer;
            }
        }
        by_path.values_mut().for_each(|file| file.ranges = merged(std::mem::take(&mut file.ranges)));
        Self { document, by_path }
    }

    fn of_buffer(&mut self, buffer: usize) -> Option<&mut SharedFile> {
        let Some(BufferSource::File(file)) = self.document.buffers.get(buffer) else { return None };
        self.by_path.get_mut(&file.located.path)
    }
}

/// The place of a range of an input buffer in an output buffer.
#[derive(Clone, Copy, Debug)]
struct MovedRange {
    start: usize,
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
    /// The URIs of the binary outputs.
    pub binaries: Vec<String>,
    /// The URIs of files that were copied under another name, by their paths.
    pub renamed: HashMap<PathBuf, String>,
    /// The URIs of images with new content, by their indices.
    pub images: BTreeMap<usize, String>,
}

/// The layout of an output.
#[derive(Debug)]
pub struct OutputLayout<'a> {
    document: &'a Document,
    pub binaries: Vec<BinaryOutput<'a>>,
    output_buffers: Vec<OutputBuffer>,
    /// The places of the kept ranges of each input buffer, in ascending order.
    moves: Vec<Arc<[MovedRange]>>,
    /// The data that is not written.
    pub unused_data: UnusedData,
    /// The buffer views of embedded images.
    image_views: Vec<Value>,
    images: Vec<EmbeddedImage>,
}

impl<'a> OutputLayout<'a> {
    /// The layout of a GLB: all buffers in the binary chunk, images in buffer views.
    ///
    /// Buffers after the first that have extras or extensions become `data:` URIs, so that these are kept.
    /// Buffers without bytes keep their JSON and follow the binary chunk.
    pub fn glb(document: &'a Document) -> Result<Self, ContentError> {
        let mut layout = Self::empty(document);
        let mut binary = BinaryOutput::default();
        let mut source = None;
        let mut aside = Vec::new();
        let (mut files, mut shared) = (SharedFiles::of(document, &layout.unused_data), Vec::new());
        for (i, buffer) in document.root.buffers.iter().enumerate() {
            let store = &document.buffers[i];
            if let BufferSource::Absent(_) | BufferSource::New(_) = store {
                if matches!(store, BufferSource::Absent(_)) && !layout.unused_data.has_buffer(i) {
                    aside.push(OutputBuffer { source: Some(i), content: BufferContent::Kept });
                }
                continue;
            }
            let is_kept = !layout.unused_data.kept_ranges(i, buffer.byte_length).is_empty();
            let is_plain = is_plain(document.element("buffers", i));
            let file = files.of_buffer(i).filter(|_| is_kept);
            match file.as_ref().map(|file| &file.place) {
                Some(SharedPlace::Binary(moves)) => {
                    layout.moves[i] = Arc::clone(moves);
                    if !is_plain {
                        aside.push(OutputBuffer { source: Some(i), content: BufferContent::Placeholder });
                    }
                    continue;
                }
                Some(SharedPlace::Aside(place)) => {
                    shared.push((i, *place));
                    if !is_plain {
                        aside.push(OutputBuffer { source: Some(i), content: BufferContent::Placeholder });
                    }
                    continue;
                }
                Some(SharedPlace::None) | None => {}
            }
            if source.is_some() && is_kept && !is_plain {
                let longest = file.map_or(i, |file| {
                    file.place = SharedPlace::Aside(aside.len());
                    file.longest
                });
                aside.push(OutputBuffer { source: Some(i), content: BufferContent::DataUri { of: longest } });
                continue;
            }
            source.get_or_insert(i);
            match file {
                Some(file) => {
                    layout.moves[i] = layout.push_ranges(file.longest, &file.ranges, &mut binary, 0)?;
                    file.place = SharedPlace::Binary(Arc::clone(&layout.moves[i]));
                }
                None => layout.push_buffer(i, &mut binary, 0)?,
            }
        }
        layout.push_new_bytes(&mut binary, 0);
        layout.push_images(&mut binary)?;
        if source.is_some() || binary.length > 0 {
            layout.output_buffers.push(OutputBuffer { source, content: BufferContent::Binary(0) });
            layout.binaries.push(binary);
        }
        let first_aside = layout.output_buffers.len();
        for output_buffer in aside {
            layout.push_unmoved(output_buffer);
        }
        for (i, place) in shared {
            layout.moves[i] = [MovedRange { start: 0, output_buffer: first_aside + place, offset: 0 }].into();
        }
        Ok(layout)
    }

    /// The layout of a `.gltf`. Buffers keep their files; those that were in memory only, or in files that an
    /// earlier run made, get new files. New bytes are appended to the first of these.
    pub fn gltf(document: &'a Document) -> Result<Self, ContentError> {
        let mut layout = Self::empty(document);
        let mut files = SharedFiles::of(document, &layout.unused_data);
        for (i, store) in document.buffers.iter().enumerate() {
            if layout.unused_data.has_buffer(i) || matches!(store, BufferSource::New(_)) {
                continue;
            }
            let has_home = matches!(store, BufferSource::Chunk | BufferSource::Decoded(_))
                || document.replaced_file(i).is_some();
            if !has_home {
                layout.push_unmoved(OutputBuffer { source: Some(i), content: BufferContent::Kept });
                continue;
            }
            let mut binary = BinaryOutput::default();
            match files.of_buffer(i) {
                Some(SharedFile { place: SharedPlace::Binary(moves), .. }) => {
                    layout.moves[i] = Arc::clone(moves);
                    if !is_plain(document.element("buffers", i)) {
                        layout.push_unmoved(OutputBuffer {
                            source: Some(i),
                            content: BufferContent::Placeholder,
                        });
                    }
                    continue;
                }
                Some(file) => {
                    let output_buffer = layout.output_buffers.len();
                    layout.moves[i] =
                        layout.push_ranges(file.longest, &file.ranges, &mut binary, output_buffer)?;
                    file.place = SharedPlace::Binary(Arc::clone(&layout.moves[i]));
                }
                None => layout.push_buffer(i, &mut binary, layout.output_buffers.len())?,
            }
            let content = BufferContent::Binary(layout.binaries.len());
            layout.output_buffers.push(OutputBuffer { source: Some(i), content });
            layout.binaries.push(binary);
        }
        if layout.new_views().next().is_none() {
            return Ok(layout);
        }
        let first = layout
            .output_buffers
            .iter()
            .position(|output_buffer| matches!(output_buffer.content, BufferContent::Binary(_)));
        let output_buffer = first.unwrap_or_else(|| {
            let content = BufferContent::Binary(layout.binaries.len());
            layout.output_buffers.push(OutputBuffer { source: None, content });
            layout.binaries.push(BinaryOutput::default());
            layout.output_buffers.len() - 1
        });
        let mut binary = std::mem::take(&mut layout.binaries[0]);
        layout.push_new_bytes(&mut binary, output_buffer);
        layout.binaries[0] = binary;
        Ok(layout)
    }

    fn empty(document: &'a Document) -> Self {
        let unused_data = UnusedData::of(document);
        let moves = vec![Arc::default(); document.root.buffers.len()];
        let (binaries, output_buffers, image_views, images) = Default::default();
        Self { document, binaries, output_buffers, moves, unused_data, image_views, images }
    }

    /// Appends the kept ranges of a buffer of the input, the first at the next multiple of four.
    fn push_buffer(
        &mut self,
        index: usize,
        binary: &mut BinaryOutput<'a>,
        output_buffer: usize,
    ) -> Result<(), ContentError> {
        let length = self.document.buffer(index, || "buffers".to_owned())?.len();
        let ranges = self.unused_data.kept_ranges(index, length);
        self.moves[index] = self.push_ranges(index, &ranges, binary, output_buffer)?;
        Ok(())
    }

    /// Appends ranges of a buffer of the input, each at a multiple of four. Returns their places.
    fn push_ranges(
        &self,
        index: usize,
        ranges: &[Range<usize>],
        binary: &mut BinaryOutput<'a>,
        output_buffer: usize,
    ) -> Result<Arc<[MovedRange]>, ContentError> {
        let bytes = self.document.buffer(index, || "buffers".to_owned())?;
        let mut moves = Vec::with_capacity(ranges.len());
        for range in ranges {
            let offset = binary.align();
            moves.push(MovedRange { start: range.start, output_buffer, offset });
            binary.append(Segment::Borrowed(&bytes[range.clone()]));
        }
        Ok(moves.into())
    }

    /// Appends an output buffer whose views keep their offsets.
    fn push_unmoved(&mut self, output_buffer: OutputBuffer) {
        let place = MovedRange { start: 0, output_buffer: self.output_buffers.len(), offset: 0 };
        // The views of a placeholder are elsewhere.
        if !matches!(output_buffer.content, BufferContent::Placeholder) {
            self.moves[output_buffer.source.unwrap_or_default()] = [place].into();
        }
        self.output_buffers.push(output_buffer);
    }

    /// The buffer views of new bytes that are kept.
    fn new_views(&self) -> impl Iterator<Item = &'a BufferView> + use<'a, '_> {
        let document = self.document;
        let views = document.root.buffer_views.iter().enumerate();
        let kept = views.filter(|&(view, _)| !self.unused_data.has_view(view)).map(|(_, view)| view);
        kept.filter(|view| matches!(document.buffers.get(view.buffer), Some(BufferSource::New(_))))
    }

    fn push_new_bytes(&mut self, binary: &mut BinaryOutput<'a>, output_buffer: usize) {
        let Some(BufferSource::New(bytes)) = self.document.buffers.last() else { return };
        let mut moves = Vec::new();
        for &BufferView { byte_offset: start, byte_length, .. } in self.new_views() {
            let piece = bytes.range(start, byte_length).unwrap_or_default();
            moves.push(MovedRange { start, output_buffer, offset: binary.push(Segment::Borrowed(piece)) });
        }
        if let Some(last) = self.moves.last_mut() {
            *last = moves.into();
        }
    }

    /// Embeds image files. References to images that are missing, remote or of unknown type are kept.
    fn push_images(&mut self, binary: &mut BinaryOutput<'a>) -> Result<(), ContentError> {
        let document = self.document;
        let mut embedded: HashMap<PathBuf, Option<(usize, &str)>> = HashMap::new();
        for (index, image) in document.root.images.iter().enumerate() {
            if let Some(ImageFile { bytes, media_type, .. }) = document.image_files.get(&index) {
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
                            format!("cannot be read: {}", system_reason(&error)),
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

    /// Appends an image. Returns the index of its buffer view in the output.
    fn push_image(&mut self, binary: &mut BinaryOutput<'a>, bytes: Segment<'a>) -> usize {
        let length = bytes.len();
        let offset = binary.push(bytes);
        self.image_views.push(object! { "buffer": 0usize, "byteOffset": offset, "byteLength": length });
        let kept = self.unused_data.view_count(self.document.root.buffer_views.len());
        kept + self.image_views.len() - 1
    }

    /// The JSON text of the output.
    pub fn json(&self, uris: &FileUris, text_layout: &TextLayout) -> Vec<u8> {
        let cleared = self.unused_data.cleared(&self.document.json);
        let root = cleared.as_ref().unwrap_or(&self.document.json);
        let replaced = [
            ("bufferViews", Some(self.views())),
            ("buffers", Some(self.buffers(uris))),
            ("images", self.images(root, uris)),
        ];
        output_text(root, &replaced, text_layout)
    }

    fn views(&self) -> Elements<'_> {
        let stored = self.document.json["bufferViews"].as_array().into_iter().flatten().enumerate();
        let kept = stored.filter(|&(view, _)| !self.unused_data.has_view(view));
        kept.map(|(_, view)| self.moved_view(view))
            .chain(self.image_views.iter().map(Cow::Borrowed))
            .collect()
    }

    /// The JSON of a buffer view after the move, with every extension that refers to a buffer.
    fn moved_view<'v>(&self, view: &'v Value) -> Cow<'v, Value> {
        let mut moved = self.moved(view);
        let extensions = view.get("extensions").and_then(Value::as_object);
        for (name, extension) in
            extensions.into_iter().flatten().filter(|(_, extension)| extension.is_object())
        {
            if let Cow::Owned(extension) = self.moved(extension) {
                moved.to_mut()["extensions"][name.as_str()] = extension;
            }
        }
        moved
    }

    /// The JSON of an object with `buffer` and `byteOffset` after the move.
    fn moved<'v>(&self, range: &'v Value) -> Cow<'v, Value> {
        let mut moved = Cow::Borrowed(range);
        let number = |key| range.get(key).and_then(Value::as_u64).map(|number| number as usize);
        let Some(buffer) = number("buffer") else { return moved };
        let start = number("byteOffset").unwrap_or(0);
        let moves = self.moves.get(buffer).map_or(&[][..], |moves| &**moves);
        let after = moves.partition_point(|moved| moved.start <= start);
        let Some(place) = after.checked_sub(1).and_then(|at| moves.get(at)) else { return moved };
        if place.output_buffer != buffer {
            moved.to_mut()["buffer"] = place.output_buffer.into();
        }
        let moved_start = (start - place.start).saturating_add(place.offset);
        if moved_start != start {
            moved.to_mut()["byteOffset"] = moved_start.into();
        }
        moved
    }

    fn buffers(&self, uris: &FileUris) -> Elements<'_> {
        self.output_buffers.iter().map(|output_buffer| self.buffer(output_buffer, uris)).collect()
    }

    fn buffer(&self, output_buffer: &OutputBuffer, uris: &FileUris) -> Cow<'_, Value> {
        let mut buffer = match output_buffer.source {
            Some(source) => Cow::Borrowed(self.document.element("buffers", source)),
            None if uris.binaries.is_empty() => Cow::Owned(object! {}),
            None => Cow::Owned(object! { "name": Buffer::NAME_FOR_NEW_DATA }),
        };
        match (&output_buffer.content, output_buffer.source) {
            (BufferContent::Binary(binary), _) => {
                let length = self.binaries[*binary].length;
                if buffer.get("byteLength").is_none_or(|before| *before != length) {
                    buffer.to_mut()["byteLength"] = length.into();
                }
                match uris.binaries.get(*binary) {
                    Some(uri) => set_text(&mut buffer, "uri", uri),
                    None if buffer.get("uri").is_some() => remove(&mut buffer, "uri"),
                    None => {}
                }
            }
            (BufferContent::DataUri { of }, _) => {
                let bytes = self.document.buffer(*of, String::new).unwrap_or_default();
                set_bytes(&mut buffer, bytes);
            }
            (BufferContent::Placeholder, _) => set_bytes(&mut buffer, &[0]),
            (_, source) => {
                if let Some(BufferSource::File(file)) = source.map(|source| &self.document.buffers[source])
                    && let Some(uri) = uris.renamed.get(&file.located.path)
                {
                    set_text(&mut buffer, "uri", uri);
                }
            }
        }
        buffer
    }

    /// The images; none if they stay as they are. `root`: the JSON with buffer views renumbered.
    fn images(&self, root: &Value, uris: &FileUris) -> Option<Elements<'_>> {
        let FileUris { renamed, images: new_files, .. } = uris;
        if self.images.is_empty() && renamed.is_empty() && new_files.is_empty() {
            return None;
        }
        let mut images = root["images"].as_array().cloned().unwrap_or_default();
        for (index, image) in self.document.root.images.iter().enumerate().filter(|_| !renamed.is_empty()) {
            let reference = image.uri.as_deref().map(|uri| self.document.resources.resolve(uri));
            let Some(Ok(UriTarget::File(located))) = reference else { continue };
            if let Some(uri) = renamed.get(&located.path) {
                images[index]["uri"] = uri.as_str().into();
            }
        }
        for (&index, uri) in new_files {
            images[index]["uri"] = uri.as_str().into();
        }
        for EmbeddedImage { index, view, media_type } in &self.images {
            let image = &mut images[*index];
            image.as_object_mut().and_then(|image| image.remove("uri"));
            image["mimeType"] = media_type.as_str().into();
            image["bufferView"] = (*view).into();
        }
        Some(images.into_iter().map(Cow::Owned).collect())
    }
}

/// The elements of an array.
type Elements<'a> = Vec<Cow<'a, Value>>;

/// The text of the root object with some of its arrays replaced. Empty arrays are left out.
fn output_text(
    root: &Value,
    replaced: &[(&'static str, Option<Elements<'_>>)],
    layout: &TextLayout,
) -> Vec<u8> {
    let new_of = |key: &str| replaced.iter().find(|(replaced, new)| *replaced == key && new.is_some());
    let kept = |key: &str| new_of(key).and_then(|(_, new)| new.as_deref()).filter(|new| !new.is_empty());
    let stored = root.as_object().into_iter().flatten().filter_map(|(key, value)| match new_of(key) {
        None => Some((key.as_str(), Part::Value(value))),
        Some(_) => kept(key).map(|new| (key.as_str(), Part::Elements(new))),
    });
    let added = replaced.iter().filter(|(key, _)| root.get(*key).is_none());
    let added = added.filter_map(|(key, _)| kept(key).map(|new| (*key, Part::Elements(new))));
    layout.text_of_object(stored.chain(added))
}

/// Sets a member to a text, unless it is that text.
fn set_text(object: &mut Cow<'_, Value>, key: &str, text: &str) {
    if object.get(key).is_none_or(|old| old != text) {
        object.to_mut()[key] = text.into();
    }
}

/// Sets the bytes of a buffer as a `data:` URI.
fn set_bytes(buffer: &mut Cow<'_, Value>, bytes: &[u8]) {
    set_text(buffer, "uri", &encode_data_uri("application/octet-stream", bytes));
    if buffer.get("byteLength").is_none_or(|before| *before != bytes.len()) {
        buffer.to_mut()["byteLength"] = bytes.len().into();
    }
}

fn remove(object: &mut Cow<'_, Value>, key: &str) {
    object.to_mut().as_object_mut().and_then(|object| object.remove(key));
}

/// Whether a buffer can be merged into another without loss of JSON members.
fn is_plain(buffer: &Value) -> bool {
    let mut keys = buffer.as_object().into_iter().flat_map(|members| members.keys());
    keys.all(|key| ["uri", "byteLength", "name"].contains(&key))
}

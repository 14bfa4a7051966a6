//! `EXT_meshopt_compression` and `KHR_meshopt_compression`: decodes compressed buffer views.
//!
//! The two extensions have the same JSON. The second permits version 1 of the vertex codec and the colour filter; a stream names its
//! version, so that one decoder serves both.
//!
//! A compressed view refers to a buffer for its decoded bytes, which usually has none. That buffer is filled, so that the offsets of
//! views stay valid.

use std::collections::{BTreeMap, BTreeSet};

use ::meshopt as codec;
use serde_json::Value;

use super::DecodeBudget;
use crate::error::ContentError;
use crate::gltf::buffers::BufferSource;
use crate::gltf::document::Document;
use crate::gltf::json;
use crate::gltf::schema::{BufferView, Meshopt};

const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// The greatest compression ratio of the codecs: a quarter of a byte encodes up to 256 zeros.
const MAX_RATIO: usize = 1024;

impl Document {
    /// Decodes every compressed view without a fallback. Returns the decoded views.
    pub(super) fn decode_meshopt(
        &mut self,
        budget: &mut DecodeBudget,
    ) -> Result<BTreeSet<usize>, ContentError> {
        let mut views = BTreeSet::new();
        if self.root.buffer_views.iter().all(|view| view.extensions.meshopt.is_none()) {
            return Ok(views);
        }
        let mut views_of_buffer: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (i, view) in self.root.buffer_views.iter().enumerate() {
            let has_fallback = !matches!(self.buffers.get(view.buffer), Some(BufferSource::Absent(_)) | None);
            if view.extensions.meshopt.is_some() && !has_fallback {
                views.insert(i);
                views_of_buffer.entry(view.buffer).or_default().push(i);
            }
        }
        // All sizes are in the JSON, so that a file that is too large is refused before anything is decoded.
        let mut lengths = Vec::new();
        for (&buffer, views) in &views_of_buffer {
            lengths.push(self.decoded_length(buffer, views, budget)?);
        }
        for ((buffer, views), length) in views_of_buffer.into_iter().zip(lengths) {
            self.fill_buffer(buffer, &views, length)?;
        }
        self.remove_meshopt()?;
        Ok(views)
    }

    /// The size of a buffer without bytes into which these views are decoded. Spends the size of the buffer and of each view.
    fn decoded_length(
        &self,
        buffer: usize,
        views: &[usize],
        budget: &mut DecodeBudget,
    ) -> Result<usize, ContentError> {
        let at = format!("buffers[{buffer}]");
        let invalid =
            |problem: &str| ContentError::invalid(&at, format!("{problem}; compress the file again"));
        let (mut length, mut decoded) = (0, 0usize);
        for &i in views {
            let view = &self.root.buffer_views[i];
            let (byte_offset, byte_length, at) = (view.byte_offset, view.byte_length, view_path(i));
            if let Some(compressed) = &view.extensions.meshopt {
                self.stream(view, compressed, &at)?;
            }
            budget.spend(byte_length, &at)?;
            length = length.max(byte_offset.saturating_add(byte_length));
            decoded = decoded.saturating_add(byte_length);
        }
        let declared = self.root.buffers.get(buffer).map(|buffer| buffer.byte_length);
        if declared.is_none_or(|declared| length > declared) {
            return Err(invalid("is shorter than the buffer views in it, or does not exist"));
        }
        // The gaps between the decoded views have no bytes in the file, so that their size must be limited.
        if length > decoded.saturating_mul(2).saturating_add(1 << 16) {
            return Err(invalid("has larger gaps between its buffer views than the views themselves"));
        }
        budget.spend(length, &at)?;
        Ok(length)
    }

    /// Fills a buffer without bytes with decoded views.
    fn fill_buffer(&mut self, buffer: usize, views: &[usize], length: usize) -> Result<(), ContentError> {
        let mut content = vec![0; length];
        for &i in views {
            let view = &self.root.buffer_views[i];
            let Some(compressed) = &view.extensions.meshopt else { continue };
            let bytes = self.decode_view(view, compressed, &view_path(i))?;
            content[view.byte_offset..][..bytes.len()].copy_from_slice(&bytes);
        }
        self.buffers[buffer] = BufferSource::Decoded(content);
        self.edit_element("buffers", buffer, |buffer| buffer["byteLength"] = length.into())?;
        Ok(())
    }

    /// The compressed bytes of a view. Errors: they are outside their buffer, or cannot hold the length of the view.
    fn stream(&self, view: &BufferView, compressed: &Meshopt, at: &str) -> Result<&[u8], ContentError> {
        let Meshopt { buffer, byte_offset, byte_length, byte_stride: stride, count, .. } = *compressed;
        let broken =
            |problem: String| ContentError::invalid(at, format!("{problem}; compress the file again"));
        let stream = self.buffer_range(buffer, byte_offset, byte_length, || at.to_owned())?;
        let length = view.byte_length;
        if count.checked_mul(stride) != Some(length) {
            return Err(broken(format!(
                "{count} elements of {stride} bytes are not the {length} bytes of the view"
            )));
        }
        if length > stream.len().saturating_mul(MAX_RATIO) {
            return Err(broken(format!("{} compressed bytes cannot hold {length}", stream.len())));
        }
        Ok(stream)
    }

    /// The bytes of a view, as many as its length.
    fn decode_view(
        &self,
        view: &BufferView,
        compressed: &Meshopt,
        at: &str,
    ) -> Result<Vec<u8>, ContentError> {
        let Meshopt { byte_stride: stride, count, ref mode, .. } = *compressed;
        // A copy: the decoder is written in C++, and the bytes of a mapped file could change under it.
        let stream = &self.stream(view, compressed, at)?.to_vec();
        let filter = compressed.filter.as_deref().unwrap_or("NONE");
        decode(mode, filter, stride, stream, count).ok_or_else(|| {
            let problem = format!(
                "the stream is broken, or is not of mode {mode:?} with elements of {stride} bytes and filter {filter:?}; compress the file again"
            );
            ContentError::invalid(at, problem)
        })
    }

    /// Removes the extensions from the JSON.
    fn remove_meshopt(&mut self) -> Result<(), ContentError> {
        for view in 0..self.root.buffer_views.len() {
            let compressed = self.root.buffer_views[view].extensions.meshopt.as_deref();
            if let Some(Meshopt { buffer, byte_offset, byte_length, .. }) = compressed {
                let range = *byte_offset..byte_offset.saturating_add(*byte_length);
                self.decoded_ranges.push((*buffer, range));
                self.edit_element("bufferViews", view, without_meshopt)?;
            }
        }
        for buffer in 0..self.root.buffers.len() {
            self.edit_element("buffers", buffer, without_meshopt)?;
        }
        self.undeclare_extensions(&NAMES);
        Ok(())
    }
}

fn view_path(view: usize) -> String {
    format!("bufferViews[{view}].extensions")
}

fn without_meshopt(object: &mut Value) {
    for name in NAMES {
        json::remove_extension(object, name);
    }
}

/// Decodes a stream. None: the stream is broken, or the combination is not allowed.
fn decode(mode: &str, filter: &str, stride: usize, stream: &[u8], count: usize) -> Option<Vec<u8>> {
    match (mode, stride) {
        ("ATTRIBUTES", _) => filtered(filter, stride, decode_attributes(stride, stream, count)?),
        _ if filter != "NONE" => None,
        ("TRIANGLES", _) if !count.is_multiple_of(3) => None,
        ("TRIANGLES", 2) => Some(shorts_to_bytes(codec::decode_index_buffer(stream, count).ok()?)),
        ("TRIANGLES", 4) => Some(words_to_bytes(codec::decode_index_buffer(stream, count).ok()?)),
        ("INDICES", 2) => Some(shorts_to_bytes(codec::decode_index_sequence(stream, count).ok()?)),
        ("INDICES", 4) => Some(words_to_bytes(codec::decode_index_sequence(stream, count).ok()?)),
        _ => None,
    }
}

fn shorts_to_bytes(values: Vec<u16>) -> Vec<u8> {
    values.into_iter().flat_map(u16::to_le_bytes).collect()
}

fn words_to_bytes(values: Vec<u32>) -> Vec<u8> {
    values.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// An element of `N` bytes. The decoder takes its stride from a type.
#[derive(Clone, Copy)]
struct Element<const N: usize>([u8; N]);

impl<const N: usize> Default for Element<N> {
    fn default() -> Self {
        Self([0; N])
    }
}

fn decode_elements<const N: usize>(stream: &[u8], count: usize) -> Option<Vec<u8>> {
    let elements: Vec<Element<N>> = codec::decode_vertex_buffer(stream, count).ok()?;
    Some(elements.iter().flat_map(|element| element.0).collect())
}

macro_rules! decode_by_stride {
    ($stride:ident, $stream:ident, $count:ident: $($n:literal)*) => {
        match $stride {
            $($n => decode_elements::<$n>($stream, $count),)*
            _ => None,
        }
    };
}

#[rustfmt::skip]
fn decode_attributes(stride: usize, stream: &[u8], count: usize) -> Option<Vec<u8>> {
    decode_by_stride!(stride, stream, count:
        4 8 12 16 20 24 28 32 36 40 44 48 52 56 60 64 68 72 76 80 84 88 92 96 100 104 108 112 116 120 124 128
        132 136 140 144 148 152 156 160 164 168 172 176 180 184 188 192 196 200 204 208 212 216 220 224 228
        232 236 240 244 248 252 256)
}

/// Undoes a filter. None: the filter does not support this stride.
fn filtered(filter: &str, stride: usize, mut bytes: Vec<u8>) -> Option<Vec<u8>> {
    match (filter, stride) {
        ("NONE", _) => return Some(bytes),
        ("OCTAHEDRAL", 4) => codec::decode_filter_oct(bytes.as_chunks_mut::<4>().0),
        ("COLOR", 4) => codec::decode_filter_color(bytes.as_chunks_mut::<4>().0),
        ("OCTAHEDRAL", 8) => on_shorts(&mut bytes, codec::decode_filter_oct::<i16>),
        ("COLOR", 8) => on_shorts(&mut bytes, codec::decode_filter_color::<i16>),
        ("QUATERNION", 8) => on_shorts(&mut bytes, codec::decode_filter_quat),
        ("EXPONENTIAL", _) => {
            let words = bytes.as_chunks::<4>().0.iter().map(|&word| [u32::from_le_bytes(word)]);
            let mut words: Vec<[u32; 1]> = words.collect();
            codec::decode_filter_exp(&mut words);
            return Some(words_to_bytes(words.into_iter().flatten().collect()));
        }
        _ => return None,
    }
    Some(bytes)
}

fn on_shorts(bytes: &mut [u8], filter: impl Fn(&mut [[i16; 4]])) {
    let shorts = bytes.as_chunks_mut::<2>().0;
    let mut values: Vec<[i16; 4]> =
        shorts.as_chunks::<4>().0.iter().map(|v| v.map(i16::from_le_bytes)).collect();
    filter(&mut values);
    for (short, value) in shorts.iter_mut().zip(values.into_iter().flatten()) {
        *short = value.to_le_bytes();
    }
}

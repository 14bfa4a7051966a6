//! `EXT_meshopt_compression` and `KHR_meshopt_compression`: decodes compressed buffer views.
//!
//! The two extensions have the same JSON. The second permits version 1 of the vertex codec and the colour
//! filter; a stream names its version, so that one decoder serves both.
//!
//! The codecs are our own: draco-gltf 0.7, the crate that has them in Rust, takes 15 s to build and decodes
//! attributes half as fast. The test `meshopt` compares them with meshoptimizer.
//!
//! A compressed view refers to a buffer for its decoded bytes, which usually has none. That buffer is filled,
//! so that the offsets of views stay valid.

mod attributes;
mod byte_groups;
mod bytes;
mod filters;
mod indices;
mod triangles;

use std::collections::{BTreeMap, BTreeSet};

use crate::json::{self, Value};

use super::DecodeBudget;
use crate::error::ContentError;
use crate::gltf::buffers::BufferSource;
use crate::gltf::document::Document;
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

    /// The size of a buffer without bytes into which these views are decoded. Spends the size of the buffer
    /// and of each view.
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

    /// The compressed bytes of a view. Errors: they are outside their buffer, or cannot hold the length of
    /// the view.
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
        let stream = self.stream(view, compressed, at)?;
        let filter = compressed.filter.as_deref().unwrap_or("NONE");
        decode(mode, filter, stride, stream, count).ok_or_else(|| {
            let problem = format!(
                "the stream is broken, or is not of mode {mode:?} with elements of {stride} bytes and filter \
                 {filter:?}; compress the file again"
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
    match (mode, stride, filter) {
        ("ATTRIBUTES", ..) => {
            let mut elements = attributes::decode(stream, count, stride)?;
            filters::undo(filter, stride, &mut elements)?;
            Some(elements)
        }
        ("TRIANGLES", 2, "NONE") => triangles::decode::<2>(stream, count),
        ("TRIANGLES", 4, "NONE") => triangles::decode::<4>(stream, count),
        ("INDICES", 2, "NONE") => indices::decode::<2>(stream, count),
        ("INDICES", 4, "NONE") => indices::decode::<4>(stream, count),
        _ => None,
    }
}

//! Finds accessors, buffer views and bytes that nothing refers to any more.
//!
//! What nothing in the input referred to is kept: it may be there for a reason that is not written in the
//! file.
//!
//! ```text
//! unused accessors = accessors without a reference
//! unused views     = views that only unused accessors refer to
//! unused bytes     = ranges of unused views, and of removed compression - ranges of all other views
//! ```

use std::ops::Range;

use crate::json::Value;

use super::buffers::BufferSource;
use super::document::Document;
use super::references::{Reference, ReferenceKind, marked, references, renumber, unknown_extension};
use super::schema::Meshopt;

/// The data that the output does not need.
#[derive(Debug, Default)]
pub struct UnusedData {
    is_unused_accessor: Vec<bool>,
    is_unused_view: Vec<bool>,
    buffers: Vec<BufferUse>,
}

/// The use of a buffer.
#[derive(Debug, Default)]
struct BufferUse {
    /// Whether there were references, and none is left.
    is_unused: bool,
    /// The ranges that are not kept, multiples of [`ALIGNMENT`], in ascending order.
    unused_ranges: Vec<Range<usize>>,
}

/// Bytes move by multiples of this number, so that alignment is kept.
const ALIGNMENT: usize = 16;

impl UnusedData {
    /// The unused data of a document, compressed data that was decoded included; nothing in a document that
    /// is as it was read, or if an unknown extension might refer to it.
    pub fn of(document: &Document) -> Self {
        let differs = document.is_changed() || document.was_compressed;
        match differs && unknown_extension(&document.json).is_none() {
            true => Self::find(document),
            false => Self::default(),
        }
    }

    /// As [`UnusedData::of`], without regard to edits and extensions.
    fn find(document: &Document) -> Self {
        let references = references(&document.json);
        let is_unused_accessor = unused_accessors(document, &references);
        let is_unused_view = unused_views(document, &references, &is_unused_accessor);
        let buffers = ranges_of_buffers(document, &is_unused_view);
        let buffers = buffers.into_iter().zip(&document.root.buffers);
        let buffers = buffers.map(|(ranges, buffer)| ranges.usage(buffer.byte_length)).collect();
        Self { is_unused_accessor, is_unused_view, buffers }
    }

    /// Whether an accessor is removed.
    fn has_accessor(&self, accessor: usize) -> bool {
        self.is_unused_accessor.get(accessor).is_some_and(|&is_unused| is_unused)
    }

    /// Whether a buffer view is removed.
    pub fn has_view(&self, view: usize) -> bool {
        self.is_unused_view.get(view).is_some_and(|&is_unused| is_unused)
    }

    /// Whether a buffer is removed.
    pub fn has_buffer(&self, buffer: usize) -> bool {
        self.buffers.get(buffer).is_some_and(|buffer| buffer.is_unused)
    }

    /// The ranges of a buffer of `length` bytes that are kept, in ascending order.
    pub fn kept_ranges(&self, buffer: usize, length: usize) -> Vec<Range<usize>> {
        if self.has_buffer(buffer) {
            return Vec::new();
        }
        let unused = self.buffers.get(buffer).map_or(&[][..], |buffer| &buffer.unused_ranges);
        let starts = [0].into_iter().chain(unused.iter().map(|unused| unused.end));
        let ends = unused.iter().map(|unused| unused.start).chain([length]);
        starts.zip(ends).map(|(start, end)| start..end).filter(|kept| !kept.is_empty()).collect()
    }

    /// The number of buffer views that are kept.
    pub fn view_count(&self, all: usize) -> usize {
        all - self.is_unused_view.iter().filter(|&&is_unused| is_unused).count()
    }

    /// The JSON without the unused accessors and with references renumbered; none if nothing is unused.
    /// Buffer views are still all there.
    pub fn cleared(&self, json: &Value) -> Option<Value> {
        let has_unused = |list: &[bool]| list.contains(&true);
        if !has_unused(&self.is_unused_accessor) && !has_unused(&self.is_unused_view) {
            return None;
        }
        let [accessors, views] =
            [&self.is_unused_accessor, &self.is_unused_view].map(|list| new_indices(list));
        let mut cleared = json.clone();
        renumber(&mut cleared, |Reference { kind, index }| {
            let new = match kind {
                ReferenceKind::Accessor => accessors.get(index),
                ReferenceKind::View | ReferenceKind::ViewOfAccessor => views.get(index),
                _ => None,
            };
            new.copied().unwrap_or(index)
        });
        if let Some(Value::Array(accessors)) = cleared.get_mut("accessors") {
            let mut index = 0..;
            accessors.retain(|_| index.next().is_none_or(|index| !self.has_accessor(index)));
            if accessors.is_empty() {
                cleared.as_object_mut().and_then(|root| root.remove("accessors"));
            }
        }
        Some(cleared)
    }
}

impl Document {
    /// A warning if unused data is kept because an unknown extension might refer to it. Returned once per
    /// document.
    pub(super) fn unused_data_warning(&mut self) -> Option<String> {
        if self.is_unused_data_reported || !self.is_changed {
            return None;
        }
        let extension = unknown_extension(&self.json)?.to_owned();
        let unused_data = UnusedData::find(self);
        let has_unused_bytes = unused_data.buffers.iter().any(|buffer| !buffer.unused_ranges.is_empty());
        self.is_unused_data_reported = has_unused_bytes || unused_data.is_unused_accessor.contains(&true);
        self.is_unused_data_reported.then(|| {
            format!(
                "data that is no longer used is kept in the file: the extension {extension} may refer to it"
            )
        })
    }
}

/// The index of every element after the unused ones before it are removed.
fn new_indices(is_unused: &[bool]) -> Vec<usize> {
    let mut next = 0;
    let step = |&is_unused: &bool| {
        let new = next;
        next += usize::from(!is_unused);
        new
    };
    is_unused.iter().map(step).collect()
}

fn unused_accessors(document: &Document, references: &[Reference]) -> Vec<bool> {
    let mut is_used = marked(document.root.accessors.len(), references, &[ReferenceKind::Accessor]);
    document.unreferenced.accessors.iter().for_each(|&kept| is_used[kept] = true);
    is_used.into_iter().map(|is_used| !is_used).collect()
}

fn unused_views(document: &Document, references: &[Reference], is_unused_accessor: &[bool]) -> Vec<bool> {
    let mut is_used = marked(document.root.buffer_views.len(), references, &[ReferenceKind::View]);
    document.unreferenced.views.iter().for_each(|&kept| is_used[kept] = true);
    let accessors = document.root.accessors.iter().zip(is_unused_accessor);
    for (accessor, _) in accessors.filter(|&(_, &is_unused)| !is_unused) {
        let sparse = accessor.sparse.iter();
        let views = sparse.flat_map(|sparse| [sparse.indices.buffer_view, sparse.values.buffer_view]);
        for view in views.chain(accessor.buffer_view) {
            if let Some(is_used) = is_used.get_mut(view) {
                *is_used = true;
            }
        }
    }
    is_used.into_iter().map(|is_used| !is_used).collect()
}

/// The ranges of a buffer that are used, and those that no longer are.
#[derive(Clone, Default)]
struct BufferRanges {
    used: Vec<Range<usize>>,
    unused: Vec<Range<usize>>,
}

fn ranges_of_buffers(document: &Document, is_unused_view: &[bool]) -> Vec<BufferRanges> {
    let mut buffers = vec![BufferRanges::default(); document.root.buffers.len()];
    let mut note = |buffer: usize, offset: usize, length: usize, is_unused: bool| {
        // Pieces of the buffer of new bytes are written view by view.
        let is_new = matches!(document.buffers.get(buffer), Some(BufferSource::New(_)));
        let Some(ranges) = buffers.get_mut(buffer).filter(|_| !is_new) else { return };
        let list = if is_unused { &mut ranges.unused } else { &mut ranges.used };
        list.push(offset..offset.saturating_add(length));
    };
    for (view, &is_unused) in document.root.buffer_views.iter().zip(is_unused_view) {
        note(view.buffer, view.byte_offset, view.byte_length, is_unused);
        if let Some(Meshopt { buffer, byte_offset, byte_length, .. }) = view.extensions.meshopt.as_deref() {
            note(*buffer, *byte_offset, *byte_length, is_unused);
        }
    }
    for (buffer, range) in &document.decoded_ranges {
        note(*buffer, range.start, range.len(), true);
    }
    buffers
}

impl BufferRanges {
    /// What is kept of a buffer of `length` bytes.
    fn usage(self, length: usize) -> BufferUse {
        let is_unused = self.used.is_empty() && !self.unused.is_empty();
        let used = merged(self.used);
        let mut unused_ranges = Vec::new();
        for unused in merged(self.unused) {
            let first = used.partition_point(|used| used.end <= unused.start);
            let within = used[first..].iter().take_while(|used| used.start < unused.end);
            let starts = [unused.start].into_iter().chain(within.clone().map(|used| used.end));
            let ends = within.map(|used| used.start).chain([unused.end]);
            for (start, end) in starts.zip(ends) {
                let whole = end.min(length).saturating_sub(start) / ALIGNMENT * ALIGNMENT;
                unused_ranges.extend((whole > 0).then_some(start..start + whole));
            }
        }
        BufferUse { is_unused, unused_ranges }
    }
}

/// Joins ranges that touch. The result is in ascending order.
pub fn merged(mut ranges: Vec<Range<usize>>) -> Vec<Range<usize>> {
    ranges.sort_unstable_by_key(|range| range.start);
    let mut merged: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        match merged.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => merged.push(range),
        }
    }
    merged
}

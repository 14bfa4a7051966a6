//! Finds accessors, buffer views and bytes that the input referred to and that nothing refers to after the edits, and removes them.
//!
//! Data that the input itself did not refer to is kept.
//!
//! ```text
//! unused accessors = accessors referred to before the edits - accessors referred to after them
//! unused views     = views of these accessors               - views that anything else refers to
//! unused bytes     = ranges of these views                  - ranges of all other views
//! ```

use std::collections::BTreeSet;
use std::ops::Range;

use super::document::Document;
use super::json_text::{edit_array, member, set_member, without_elements};
use super::references::{IndexReference, ReferenceKind, references, unknown_extension};
use super::schema::{BufferView, Meshopt};

/// The data that the output does not need.
#[derive(Debug, Default)]
pub struct UnusedData {
    /// Indices of accessors. New accessors follow those of the input.
    accessors: BTreeSet<usize>,
    views: BTreeSet<usize>,
    /// Buffers without any used byte.
    buffers: BTreeSet<usize>,
    /// The unused ranges of each buffer, in ascending order.
    unused_ranges: Vec<Vec<UnusedRange>>,
}

/// An unused range of a buffer, a multiple of [`ALIGNMENT`] long.
#[derive(Clone, Debug)]
struct UnusedRange {
    range: Range<usize>,
    /// The total length of all unused ranges up to the end of this one.
    total: usize,
}

/// Bytes move by multiples of this number, so that alignment is kept.
const ALIGNMENT: usize = 16;

impl UnusedData {
    /// The unused data of a document; nothing if an unknown extension might refer to it.
    pub fn of(document: &Document) -> serde_json::Result<Self> {
        let found = if document.is_changed() { Self::find(document)? } else { None };
        Ok(found.filter(|_| unknown_extension(document.text()).is_none()).unwrap_or_default())
    }

    /// As [`UnusedData::of`], without regard to extensions. None: some references cannot be read.
    fn find(document: &Document) -> serde_json::Result<Option<Self>> {
        let (before, after) = (references(document.text()), references(&edited(document)?));
        let (Some(before), Some(after)) = (before, after) else { return Ok(None) };
        let accessors = unused_accessors(document, &before, &after);
        let views = unused_views(document, &accessors, &before, &after);
        let stored: Vec<BufferView> = match member(document.text(), "bufferViews")? {
            Some(views) => serde_json::from_str(views)?,
            None => Vec::new(),
        };
        let mut unused_data = Self { accessors, views, buffers: BTreeSet::new(), unused_ranges: Vec::new() };
        let uses = uses(document, &stored, &unused_data.views);
        for (buffer, uses) in uses.into_iter().enumerate() {
            let length = document.root.buffers[buffer].byte_length;
            if uses.live.is_empty() && !uses.dead.is_empty() {
                unused_data.buffers.insert(buffer);
            }
            unused_data.unused_ranges.push(uses.unused_ranges(length));
        }
        Ok(Some(unused_data))
    }

    /// Whether a buffer of the input is removed.
    pub fn has_buffer(&self, buffer: usize) -> bool {
        self.buffers.contains(&buffer)
    }

    /// Whether a new buffer view is removed, by its index among the new ones.
    pub fn has_new_view(&self, document: &Document, place: usize) -> bool {
        self.views.contains(&(document.root.buffer_views.len() + place))
    }

    /// Whether parts of a buffer are removed.
    pub fn has_unused_ranges(&self, buffer: usize) -> bool {
        self.unused_ranges.get(buffer).is_some_and(|unused_ranges| !unused_ranges.is_empty())
    }

    /// The parts of a buffer that are kept.
    pub fn kept<'a>(&self, buffer: usize, bytes: &'a [u8]) -> Vec<&'a [u8]> {
        if self.has_buffer(buffer) {
            return Vec::new();
        }
        let unused_ranges = self.unused_ranges.get(buffer).into_iter().flatten().map(|unused| &unused.range);
        let ends = unused_ranges.clone().map(|unused| unused.start).chain([bytes.len()]);
        let starts = [0].into_iter().chain(unused_ranges.map(|unused| unused.end));
        starts.zip(ends).map(|(start, end)| &bytes[start..end]).filter(|part| !part.is_empty()).collect()
    }

    /// The offset of a byte after the unused ranges before it are removed.
    pub fn moved(&self, buffer: usize, offset: usize) -> usize {
        let unused_ranges = self.unused_ranges.get(buffer).map_or(&[][..], Vec::as_slice);
        let before = unused_ranges.partition_point(|unused| unused.range.end <= offset);
        offset - before.checked_sub(1).map_or(0, |last| unused_ranges[last].total)
    }

    /// The JSON of the root object without the unused accessors and buffer views, with references renumbered.
    pub fn cleared(&self, root: String) -> serde_json::Result<String> {
        if self.accessors.is_empty() && self.views.is_empty() {
            return Ok(root);
        }
        let references = references(&root);
        let references = references.ok_or_else(|| serde::de::Error::custom("a reference is not an index"))?;
        let mut cleared = self.renumbered(&root, references);
        for (key, dead) in [("accessors", &self.accessors), ("bufferViews", &self.views)] {
            if let Some(array) = member(&cleared, key)? {
                let kept = without_elements(array, dead)?;
                cleared = set_member(&cleared, key, kept.as_deref())?;
            }
        }
        Ok(cleared)
    }

    fn renumbered(&self, root: &str, mut references: Vec<IndexReference>) -> String {
        references.sort_by_key(|reference| reference.range.start);
        let [accessors, views] =
            [&self.accessors, &self.views].map(|dead| Vec::from_iter(dead.iter().copied()));
        let mut out = String::with_capacity(root.len());
        let mut copied = 0;
        for IndexReference { kind, index, range } in references {
            let dead = match kind {
                ReferenceKind::Accessor => &accessors,
                ReferenceKind::View | ReferenceKind::ViewOfAccessor => &views,
                _ => continue,
            };
            out.push_str(&root[copied..range.start]);
            out.push_str(&(index - dead.partition_point(|&dead| dead < index)).to_string());
            copied = range.end;
        }
        out.push_str(&root[copied..]);
        out
    }
}

impl Document {
    /// A warning if unused data is kept because an unknown extension might refer to it. Returned once per document.
    pub(super) fn unused_data_warning(&mut self) -> Option<String> {
        let extension = unknown_extension(self.text()).filter(|_| !self.edits.is_unused_data_reported)?;
        let unused_data = UnusedData::find(self).ok().flatten()?;
        let has_unused_ranges =
            (0..unused_data.unused_ranges.len()).any(|buffer| unused_data.has_unused_ranges(buffer));
        let is_there = has_unused_ranges || !unused_data.accessors.is_empty();
        self.edits.is_unused_data_reported = is_there;
        is_there.then(|| {
            format!(
                "data that is no longer used is kept in the file: the extension {extension} may refer to it"
            )
        })
    }
}

/// The JSON of the root object with all edits of references.
fn edited(document: &Document) -> serde_json::Result<String> {
    let edits = &document.edits;
    let mut root = document.text().to_owned();
    if let Some(meshes) = member(&root, "meshes")? {
        let meshes = document.edited_meshes(meshes)?;
        root = set_member(&root, "meshes", Some(&meshes))?;
    }
    for (key, edited, appended) in edits.edited_arrays() {
        let elements = edit_array(member(&root, key)?.unwrap_or("[]"), edited, appended)?;
        root = set_member(&root, key, Some(&elements))?;
    }
    if let Some(images) = member(&root, "images")? {
        let images = edit_array(images, &edits.images, &[])?;
        root = set_member(&root, "images", Some(&images))?;
    }
    let accessors = member(&root, "accessors")?.unwrap_or("[]");
    let accessors = edit_array(accessors, &edits.accessors, &edits.new_accessors)?;
    set_member(&root, "accessors", Some(&accessors).filter(|text| *text != "[]").map(String::as_str))
}

fn numbers(references: &[IndexReference], kinds: &[ReferenceKind]) -> BTreeSet<usize> {
    references
        .iter()
        .filter(|reference| kinds.contains(&reference.kind))
        .map(|reference| reference.index)
        .collect()
}

fn unused_accessors(
    document: &Document,
    before: &[IndexReference],
    after: &[IndexReference],
) -> BTreeSet<usize> {
    let mut used = numbers(before, &[ReferenceKind::Accessor]);
    used.extend(&document.edits.formerly_referenced);
    used.retain(|&number| number < document.root.accessors.len());
    &used - &numbers(after, &[ReferenceKind::Accessor])
}

fn unused_views(
    document: &Document,
    unused_accessors: &BTreeSet<usize>,
    before: &[IndexReference],
    after: &[IndexReference],
) -> BTreeSet<usize> {
    let mut used = numbers(before, &[ReferenceKind::View, ReferenceKind::ViewOfAccessor]);
    let mut live = numbers(after, &[ReferenceKind::View]);
    for (number, accessor) in document.root.accessors.iter().enumerate() {
        let views = if unused_accessors.contains(&number) { &mut used } else { &mut live };
        views.extend(accessor.buffer_view);
        let sparse = accessor.sparse.iter();
        views.extend(sparse.flat_map(|sparse| [sparse.indices.buffer_view, sparse.values.buffer_view]));
    }
    used.retain(|&number| number < document.root.buffer_views.len() + document.edits.new_views.len());
    &used - &live
}

/// The ranges of a buffer that buffer views refer to.
#[derive(Clone, Default)]
struct BufferUses {
    live: Vec<Range<usize>>,
    dead: Vec<Range<usize>>,
}

/// The uses of each buffer of the input. `stored` are the buffer views of the file, `dead` are those that are removed.
fn uses(document: &Document, stored: &[BufferView], dead: &BTreeSet<usize>) -> Vec<BufferUses> {
    let mut uses = vec![BufferUses::default(); document.root.buffers.len()];
    for (number, (old, new)) in stored.iter().zip(&document.root.buffer_views).enumerate() {
        let is_dead = dead.contains(&number);
        let mut note = |buffer: usize, offset: usize, length: usize, is_dead: bool| {
            let Some(uses) = uses.get_mut(buffer) else { return };
            let list = if is_dead { &mut uses.dead } else { &mut uses.live };
            list.push(offset..offset.saturating_add(length));
        };
        note(old.buffer, old.byte_offset, old.byte_length, is_dead);
        if let Some(Meshopt { buffer, byte_offset, byte_length, .. }) = old.extensions.meshopt.as_deref() {
            let is_decoded = new.extensions.meshopt.is_none();
            note(*buffer, *byte_offset, *byte_length, is_dead || is_decoded);
        }
    }
    uses
}

impl BufferUses {
    /// The parts of dead ranges outside live ones, below `length`, in multiples of [`ALIGNMENT`].
    fn unused_ranges(self, length: usize) -> Vec<UnusedRange> {
        let live = merged_ranges(self.live);
        let (mut unused_ranges, mut total) = (Vec::new(), 0);
        for dead in merged_ranges(self.dead) {
            let first = live.partition_point(|live| live.end <= dead.start);
            let within = live[first..].iter().take_while(|live| live.start < dead.end);
            let starts = [dead.start].into_iter().chain(within.clone().map(|live| live.end));
            let ends = within.map(|live| live.start).chain([dead.end]);
            for (start, end) in starts.zip(ends) {
                let whole = end.min(length).saturating_sub(start) / ALIGNMENT * ALIGNMENT;
                total += whole;
                unused_ranges
                    .extend((whole > 0).then_some(UnusedRange { range: start..start + whole, total }));
            }
        }
        unused_ranges
    }
}

/// Joins ranges that touch. The result is in ascending order.
fn merged_ranges(mut ranges: Vec<Range<usize>>) -> Vec<Range<usize>> {
    ranges.sort_unstable_by_key(|range| range.start);
    let mut merged_ranges: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        match merged_ranges.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => merged_ranges.push(range),
        }
    }
    merged_ranges
}

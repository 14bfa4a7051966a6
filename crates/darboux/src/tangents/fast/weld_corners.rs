//! Welding of corners, for meshes without indices and for small parts of large vertex lists.
//!
//! Distinct corners are numbered in the order of their first occurrence.

use std::ops::Range;

use crate::Mesh;

use crate::exec::simd::{Task, Width};
use crate::exec::windows::WINDOW;
use crate::tangents::fast::hash_table::{ChainedTable, HashFilter};
use crate::tangents::fast::vertex_hash::{HashVertices, ValueRange};
use crate::tangents::fast::vertex_record::{SliceBuffer, VertexRecord, VertexSlices, same_bits};

/// The number of recent vertices that are compared before the table is searched.
const RECENT_VERTICES: usize = if cfg!(small_limits) { 2 } else { 1 << 14 };

/// The distinct corners of a range of corners. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct CornerWeld {
    pub distinct: DistinctVertices,
    pub value_range: ValueRange,
    /// The last vertex for each value of a hash's lowest bits.
    recent: Vec<u32>,
    /// The corners of the current window.
    records: Vec<VertexRecord>,
    /// The hashes of these corners.
    hashes: Vec<u32>,
    /// The number of each distinct vertex among those of the whole mesh.
    numbers: Vec<u32>,
}

impl CornerWeld {
    /// Numbers the corners of `range`.
    pub fn weld(
        &mut self,
        mesh: &Mesh<'_>,
        range: Range<usize>,
        width: Width,
        buffer: &mut SliceBuffer,
        welded: &mut [u32],
    ) {
        let Self { distinct, value_range, recent, records, hashes, .. } = self;
        distinct.clear(range.len());
        *value_range = ValueRange::default();
        recent.clear();
        recent.resize(RECENT_VERTICES, 0);
        for (start, welded) in range.step_by(WINDOW).zip(welded.chunks_mut(WINDOW)) {
            let slices = VertexSlices::of_corners(mesh, start..start + welded.len(), buffer);
            hashes.resize(welded.len(), 0);
            width.run(HashVertices { slices, hashes, value_range });
            records.resize(welded.len(), VertexRecord::default());
            width.run(PackRecords { slices, records });
            width.run(NumberCorners { records, hashes, recent, distinct, welded });
        }
    }

    /// Adds the distinct corners of a later range to these, of the first range.
    pub fn append(&mut self, later: &mut Self) {
        let DistinctVertices { records, table, .. } = &later.distinct;
        let number = |(record, &hash): (&VertexRecord, &u32)| self.distinct.number(record, hash);
        later.numbers.clear();
        later.numbers.extend(records.iter().zip(table.hashes()).map(number));
        self.distinct.has_long_chain |= later.distinct.has_long_chain;
    }

    /// Turns numbers within this range into those that [`CornerWeld::append`] has found.
    pub fn renumber(&self, welded: &mut [u32]) {
        welded.iter_mut().for_each(|vertex| *vertex = self.numbers[*vertex as usize]);
    }
}

/// Distinct vertices, numbered.
#[derive(Debug, Default)]
pub(crate) struct DistinctVertices {
    pub records: Vec<VertexRecord>,
    /// Too many vertices have one hash.
    pub has_long_chain: bool,
    seen: HashFilter,
    table: ChainedTable,
}

impl DistinctVertices {
    /// Removes all vertices, and chooses a size for the vertices of so many corners.
    fn clear(&mut self, corners: usize) {
        self.records.clear();
        self.has_long_chain = false;
        self.seen.clear(corners / 4);
        self.table.clear(corners / 8);
    }

    /// The number of a vertex, which is added if it is new.
    #[inline(always)]
    fn number(&mut self, record: &VertexRecord, hash: u32) -> u32 {
        // Most vertices are new, and the filter tells so for most of these without a search.
        let is_equal = |known: u32| self.records[known as usize] == *record;
        let known = if self.seen.insert(hash) { self.table.find(hash, is_equal) } else { Ok(None) };
        self.has_long_chain |= known.is_err();
        match known.unwrap_or(None) {
            Some(known) => known,
            None => {
                let new = self.records.len() as u32;
                self.table.push(hash);
                self.records.push(*record);
                new
            }
        }
    }
}

/// Copies vertices into records.
struct PackRecords<'a> {
    slices: VertexSlices<'a>,
    records: &'a mut [VertexRecord],
}

impl Task for PackRecords<'_> {
    #[inline(always)]
    fn run(self) {
        let VertexSlices { positions, normals, uvs } = self.slices;
        let values = positions.iter().zip(normals).zip(uvs);
        for (record, ((position, normal), uv)) in self.records.iter_mut().zip(values) {
            record[..3].copy_from_slice(position);
            record[3..6].copy_from_slice(normal);
            record[6..].copy_from_slice(uv);
        }
    }
}

/// Finds the vertex of each corner, first among the recent vertices.
struct NumberCorners<'a> {
    records: &'a [VertexRecord],
    hashes: &'a [u32],
    recent: &'a mut [u32],
    distinct: &'a mut DistinctVertices,
    welded: &'a mut [u32],
}

impl Task for NumberCorners<'_> {
    #[inline(always)]
    fn run(self) {
        for ((corner, &hash), vertex) in self.records.iter().zip(self.hashes).zip(self.welded) {
            let recent = &mut self.recent[hash as usize % RECENT_VERTICES];
            let is_recent =
                self.distinct.records.get(*recent as usize).is_some_and(|record| same_bits(record, corner));
            if !is_recent {
                *recent = self.distinct.number(corner, hash);
            }
            *vertex = *recent;
        }
    }
}

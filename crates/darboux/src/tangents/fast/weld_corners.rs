//! Welding of corners, for meshes without indices and for small parts of large vertex lists: distinct corners are numbered in the order in which they are first met.

use std::ops::Range;

use crate::Mesh;

use crate::exec::simd::{Task, Width};
use crate::exec::windows::WINDOW;
use crate::tangents::fast::hash_table::{BitMap, Chains};
use crate::tangents::fast::kernel::Record;
use crate::tangents::fast::rows::{RowBuffer, Rows};
use crate::tangents::fast::vertex_hash::{Hash, Span};

/// How many recently met vertices are looked at first.
const RECENT: usize = if cfg!(small_limits) { 2 } else { 1 << 14 };

/// The distinct corners of a stretch of a mesh; the memory is kept from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Corners {
    pub distinct: Distinct,
    pub span: Span,
    /// The last vertex met with each lowest part of a hash.
    recent: Vec<u32>,
    /// Those of the current window, and their hashes.
    window: Vec<Record>,
    hashes: Vec<u32>,
    /// The number of each vertex among those of the whole mesh.
    numbers: Vec<u32>,
}

impl Corners {
    /// Numbers the corners of `range`.
    pub fn weld(
        &mut self,
        mesh: &Mesh<'_>,
        range: Range<usize>,
        width: Width,
        buffer: &mut RowBuffer,
        of: &mut [u32],
    ) {
        self.distinct.clear(range.len());
        self.span = Span::default();
        self.recent.clear();
        self.recent.resize(RECENT, 0);
        for (start, of) in range.step_by(WINDOW).zip(of.chunks_mut(WINDOW)) {
            let rows = Rows::of_corners(mesh, start..start + of.len(), buffer);
            self.hashes.resize(of.len(), 0);
            width.run(Hash { rows, hashes: &mut self.hashes, span: &mut self.span });
            self.window.resize(of.len(), Record::default());
            width.run(Assemble { rows, records: &mut self.window });
            let Self { distinct, recent, window: corners, hashes, .. } = self;
            width.run(Number { corners, hashes, recent, distinct, of });
        }
    }

    /// Adds the corners of a later stretch to these, of the first.
    pub fn absorb(&mut self, later: &mut Self) {
        let Distinct { records, chains, .. } = &later.distinct;
        let number = |(record, &hash): (&Record, &u32)| self.distinct.number(record, hash);
        later.numbers.clear();
        later.numbers.extend(records.iter().zip(chains.hashes()).map(number));
        self.distinct.refused |= later.distinct.refused;
    }

    /// Turns numbers within this stretch into those that [`Corners::absorb`] has found.
    pub fn renumber(&self, of: &mut [u32]) {
        of.iter_mut().for_each(|vertex| *vertex = self.numbers[*vertex as usize]);
    }
}

/// Distinct vertices, numbered.
#[derive(Debug, Default)]
pub(crate) struct Distinct {
    pub records: Vec<Record>,
    /// Some that are equal as floats differ in the sign of a zero, or too many have one hash.
    pub refused: bool,
    seen: BitMap,
    chains: Chains,
}

impl Distinct {
    /// No vertex, in a size for those of so many corners.
    fn clear(&mut self, corners: usize) {
        self.records.clear();
        self.refused = false;
        self.seen.clear(corners / 4);
        self.chains.clear(corners / 8);
    }

    /// The number of a vertex, which may be new.
    #[inline(always)]
    fn number(&mut self, record: &Record, hash: u32) -> u32 {
        // Most are new, and most of these have a hash never seen: nothing to look for.
        let is_same = |known: u32| self.records[known as usize] == *record;
        let known = if self.seen.set(hash) { self.chains.find(hash, is_same) } else { Ok(None) };
        self.refused |= known.is_err();
        match known.unwrap_or(None) {
            Some(known) => {
                self.refused |= !same(&self.records[known as usize], record);
                known
            }
            None => {
                let new = self.records.len() as u32;
                self.chains.push(hash);
                self.records.push(*record);
                new
            }
        }
    }
}

/// Writes rows as records.
struct Assemble<'a> {
    rows: Rows<'a>,
    records: &'a mut [Record],
}

impl Task for Assemble<'_> {
    #[inline(always)]
    fn run(self) {
        let Rows { positions, normals, uvs } = self.rows;
        let rows = positions.iter().zip(normals).zip(uvs);
        for (record, ((position, normal), uv)) in self.records.iter_mut().zip(rows) {
            record[..3].copy_from_slice(position);
            record[3..6].copy_from_slice(normal);
            record[6..].copy_from_slice(uv);
        }
    }
}

/// Finds the vertex of each corner, among the recent ones or all.
struct Number<'a> {
    corners: &'a [Record],
    hashes: &'a [u32],
    recent: &'a mut [u32],
    distinct: &'a mut Distinct,
    of: &'a mut [u32],
}

impl Task for Number<'_> {
    #[inline(always)]
    fn run(self) {
        for ((corner, &hash), of) in self.corners.iter().zip(self.hashes).zip(self.of) {
            let recent = &mut self.recent[hash as usize % RECENT];
            let is_recent =
                self.distinct.records.get(*recent as usize).is_some_and(|record| same(record, corner));
            if !is_recent {
                *recent = self.distinct.number(corner, hash);
            }
            *of = *recent;
        }
    }
}

/// True for equal bits.
#[inline(always)]
pub(crate) fn same(a: &Record, b: &Record) -> bool {
    let mut difference = 0;
    for i in 0..8 {
        difference |= a[i].to_bits() ^ b[i].to_bits();
    }
    difference == 0
}

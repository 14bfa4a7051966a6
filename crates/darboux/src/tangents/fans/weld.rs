//! Welding by hashing: vertices whose position, normal and UV are equal as floats become the first of them.
//!
//! The reference names a welded vertex after one of its corners, in an order of its own. That order can show only where the
//! values are not finite (or so large that it does not weld them), and where equal vertices differ in the sign of a zero; such
//! meshes are refused here. (It shows in one other place, the last run of edges: see `last_run`.)

use crate::weld::Bounds;
use crate::{Indices, Mesh};

use super::block::Record;
use super::hash::{Hash, Span};
use super::source::{Identity, Rows, record};
use super::width::{Task, Width};
use super::workers::{self, Worker, parts, split};
use super::{WINDOW, windows_of};

/// The welded vertices of a mesh; the memory is kept from mesh to mesh.
#[derive(Debug, Default)]
pub(super) struct Weld {
    /// By vertex, or by corner of an unindexed mesh; empty when every vertex is its own.
    of: Vec<u32>,
    per_corner: bool,
    /// The welded vertices of an unindexed mesh.
    records: Vec<Record>,
    /// The number of welded vertices, those that are copies of another or unused included.
    pub count: usize,
    /// Of all positions, unused ones included.
    pub bounds: Bounds,
    hashes: Vec<u32>,
    seen: BitMap,
    again: BitMap,
    table: Vec<u64>,
    recent: Vec<u32>,
    chains: Chains,
    /// Those of the current window.
    corners: Vec<Record>,
}

/// The mesh has values that only the reference's own order of vertices decides.
pub(super) struct Refused;

/// No vertex in this slot. Others hold a hash above and the number of a vertex below.
const FREE: u64 = u64::MAX;

/// How many recently met vertices are looked at first, in an unindexed mesh.
const RECENT: usize = if cfg!(small_limits) { 2 } else { 1 << 14 };

impl Weld {
    /// Welds the vertices of an indexed mesh, or the corners of an unindexed one.
    pub fn weld(&mut self, mesh: &Mesh<'_>, width: Width, workers: &mut [Worker]) -> Result<(), Refused> {
        self.of.clear();
        self.per_corner = matches!(mesh.indices(), Indices::Unindexed);
        if self.per_corner {
            return self.weld_corners(mesh, width, &mut workers[0]);
        }
        self.count = mesh.vertex_count();
        let collisions = self.find_collisions(mesh, width, workers)?;
        if collisions > 0 { self.weld_collisions(mesh, collisions) } else { Ok(()) }
    }

    pub fn identity(&self) -> Identity<'_> {
        match (self.per_corner, self.of.is_empty()) {
            (true, _) => Identity::OfCorner(&self.of, &self.records),
            (false, true) => Identity::Own,
            (false, false) => Identity::OfVertex(&self.of),
        }
    }

    /// Hashes all vertices, marks hash values met more than once, and returns how many there are at most.
    ///
    /// Few meshes have equal vertices: two bits per hash value, which stay in the cache, leave few vertices to compare.
    fn find_collisions(
        &mut self,
        mesh: &Mesh<'_>,
        width: Width,
        workers: &mut [Worker],
    ) -> Result<usize, Refused> {
        self.seen.clear(self.count);
        self.again.clear(self.count);
        self.hashes.resize(self.count, 0);
        let count = workers.len();
        let ranges = split(0..self.count, count, 1);
        let mut spans = vec![Span::default(); count];
        let jobs = ranges.clone().zip(parts(&mut self.hashes, 0, ranges)).zip(&mut spans);
        workers::run(workers, jobs, |worker, ((range, hashes), span)| {
            for (first, hashes) in range.step_by(WINDOW).zip(hashes.chunks_mut(WINDOW)) {
                let rows = Rows::new(mesh, first..first + hashes.len(), &mut worker.rows);
                width.run(Hash { rows, hashes, span: &mut *span });
            }
        });
        let mut found = vec![0; count];
        let (hashes, bits) = (&self.hashes[..], self.seen.bits);
        let ranges = split(0..self.seen.words.len(), count, 1);
        let maps = parts(&mut self.seen.words, 0, ranges.clone()).zip(parts(
            &mut self.again.words,
            0,
            ranges.clone(),
        ));
        workers::run(workers, ranges.zip(maps).zip(&mut found), |_, ((range, (seen, again)), found)| {
            *found = mark_collisions(hashes, bits, range.start, seen, again);
        });
        self.bounds = Span::check(&spans)?;
        Ok(found.iter().sum())
    }

    /// Compares the vertices whose hash values were met more than once.
    fn weld_collisions(&mut self, mesh: &Mesh<'_>, collisions: usize) -> Result<(), Refused> {
        let slots = (4 * collisions).next_power_of_two();
        self.table.clear();
        self.table.resize(slots, FREE);
        for (vertex, &hash) in self.hashes.iter().enumerate().filter(|(_, hash)| self.again.has(**hash)) {
            let mut slot = slot(hash, slots);
            while self.table[slot] != FREE {
                let first = self.table[slot] as u32;
                if has_hash(self.table[slot], hash) && are_one(mesh, first as usize, vertex)? {
                    if self.of.is_empty() {
                        self.of.extend(0..self.count as u32);
                    }
                    self.of[vertex] = first;
                    break;
                }
                slot = (slot + 1) & (slots - 1);
            }
            if self.table[slot] == FREE {
                self.table[slot] = entry(hash, vertex as u32);
            }
        }
        Ok(())
    }

    /// Numbers the distinct corners of an unindexed mesh in the order in which they are first met, and writes them.
    fn weld_corners(&mut self, mesh: &Mesh<'_>, width: Width, worker: &mut Worker) -> Result<(), Refused> {
        let corners = mesh.corner_count();
        self.seen.clear(corners / 4);
        self.chains.clear(corners / 8);
        self.recent.clear();
        self.recent.resize(RECENT, 0);
        self.records.clear();
        self.of.resize(corners, 0);
        self.hashes.resize(WINDOW, 0);
        let (mut span, mut refused) = (Span::default(), false);
        for range in windows_of(corners) {
            let rows = Rows::new(mesh, range.clone(), &mut worker.rows);
            let hashes = &mut self.hashes[..range.len()];
            width.run(Hash { rows, hashes, span: &mut span });
            self.corners.resize(range.len(), Record::default());
            width.run(Assemble { rows, records: &mut self.corners });
            width.run(Number {
                corners: &self.corners,
                hashes,
                recent: &mut self.recent,
                seen: &mut self.seen,
                chains: &mut self.chains,
                records: &mut self.records,
                of: &mut self.of[range],
                refused: &mut refused,
            });
        }
        self.count = self.records.len();
        self.bounds = Span::check(&[span])?;
        if refused { Err(Refused) } else { Ok(()) }
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
        for (((record, position), normal), uv) in self.records.iter_mut().zip(positions).zip(normals).zip(uvs)
        {
            record[..3].copy_from_slice(position);
            record[3..6].copy_from_slice(normal);
            record[6..].copy_from_slice(uv);
        }
    }
}

/// Finds the vertex of each corner, among the recent ones or all, or makes a new one.
struct Number<'a> {
    corners: &'a [Record],
    hashes: &'a [u32],
    recent: &'a mut [u32],
    seen: &'a mut BitMap,
    chains: &'a mut Chains,
    records: &'a mut Vec<Record>,
    of: &'a mut [u32],
    refused: &'a mut bool,
}

impl Task for Number<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { corners, hashes, recent, seen, chains, records, of, refused } = self;
        for ((corner, &hash), of) in corners.iter().zip(hashes).zip(of) {
            let recent = &mut recent[hash as usize % RECENT];
            let is_recent = records.get(*recent as usize).is_some_and(|record| same(record, corner));
            if !is_recent {
                // Most vertices that are not recent are new, and most of these have a hash never seen: nothing to look for.
                let known = if seen.set(hash) { chains.find(records, hash, corner) } else { None };
                *recent = known.unwrap_or(records.len() as u32);
                match known {
                    Some(known) => *refused |= !same(&records[known as usize], corner),
                    None => {
                        chains.push(hash);
                        records.push(*corner);
                    }
                }
            }
            *of = *recent;
        }
    }
}

/// Vertices in lists by hash. They are put in when something is looked for: many at once, for whose memory is waited together.
#[derive(Debug, Default)]
struct Chains {
    /// The hashes of vertices that are not in a list yet.
    hashes: Vec<u32>,
    /// The last vertex of each list, and before each vertex the one put in before; or [`END`].
    last: Vec<u32>,
    before: Vec<u32>,
}

/// The end of a list.
const END: u32 = u32::MAX;

impl Chains {
    /// No vertex, in a size for about `count`.
    fn clear(&mut self, count: usize) {
        let lists = if cfg!(small_limits) { 2 } else { count.next_power_of_two() };
        self.last.clear();
        self.last.resize(lists, END);
        self.before.clear();
        self.hashes.clear();
    }

    /// Takes the next vertex.
    #[inline(always)]
    fn push(&mut self, hash: u32) {
        self.hashes.push(hash);
    }

    /// The vertex with this record.
    #[inline(never)]
    fn find(&mut self, records: &[Record], hash: u32, record: &Record) -> Option<u32> {
        let lists = self.last.len();
        let first = self.before.len() as u32;
        let put_in = |(&hash, vertex)| std::mem::replace(&mut self.last[slot(hash, lists)], vertex);
        self.before.extend(self.hashes.iter().zip(first..).map(put_in));
        self.hashes.clear();
        let mut vertex = self.last[slot(hash, self.last.len())];
        while vertex != END && records[vertex as usize] != *record {
            vertex = self.before[vertex as usize];
        }
        (vertex != END).then_some(vertex)
    }
}

fn entry(hash: u32, vertex: u32) -> u64 {
    u64::from(hash) << 32 | u64::from(vertex)
}

fn has_hash(entry: u64, hash: u32) -> bool {
    (entry >> 32) as u32 == hash
}

/// The first slot of a hash in a table of `slots`, a power of two: other bits than those that choose a recent vertex.
fn slot(hash: u32, slots: usize) -> usize {
    ((u64::from(hash) * slots as u64) >> 32) as usize
}

/// One bit for each of many hash values.
#[derive(Debug, Default)]
struct BitMap {
    words: Vec<u64>,
    /// How many of a hash's highest bits choose the bit.
    bits: u32,
}

impl BitMap {
    /// No bit set, in a size for `count` hashes.
    fn clear(&mut self, count: usize) {
        self.bits = if cfg!(small_limits) { 2 } else { (8 * count).max(64).ilog2().min(31) + 1 };
        self.words.clear();
        self.words.resize((1usize << self.bits).div_ceil(64), 0);
    }

    /// Sets a hash's bit; true if it was.
    #[inline(always)]
    fn set(&mut self, hash: u32) -> bool {
        let (word, bit) = place(hash, self.bits);
        let was_set = self.words[word] & bit != 0;
        self.words[word] |= bit;
        was_set
    }

    fn has(&self, hash: u32) -> bool {
        let (word, bit) = place(hash, self.bits);
        self.words[word] & bit != 0
    }
}

/// The word and the bit of a hash.
#[inline(always)]
fn place(hash: u32, bits: u32) -> (usize, u64) {
    let at = ((u64::from(hash) << bits) >> 32) as usize;
    (at / 64, 1 << (at % 64))
}

/// Marks hashes in `seen` and those met before in `again`, both the words from `first` on; returns how many of these there are.
fn mark_collisions(hashes: &[u32], bits: u32, first: usize, seen: &mut [u64], again: &mut [u64]) -> usize {
    let mut collisions = 0;
    if seen.is_empty() {
        return 0;
    }
    for &hash in hashes {
        let (word, bit) = place(hash, bits);
        // Whether a hash is among these words cannot be foretold: no branch.
        let at = word.wrapping_sub(first);
        let (at, bit) = if at < seen.len() { (at, bit) } else { (0, 0) };
        let met = seen[at] & bit;
        again[at] |= met;
        seen[at] |= bit;
        collisions += usize::from(met != 0);
    }
    collisions
}

/// True for vertices that are equal as floats. Refuses those whose zeros differ in sign.
fn are_one(mesh: &Mesh<'_>, a: usize, b: usize) -> Result<bool, Refused> {
    let (a, b) = (record(mesh, a), record(mesh, b));
    if a != b {
        return Ok(false);
    }
    if same(&a, &b) { Ok(true) } else { Err(Refused) }
}

/// True for equal bits.
#[inline(always)]
fn same(a: &Record, b: &Record) -> bool {
    let mut difference = 0;
    for i in 0..8 {
        difference |= a[i].to_bits() ^ b[i].to_bits();
    }
    difference == 0
}

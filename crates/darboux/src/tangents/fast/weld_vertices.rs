//! Welding by hashing: every vertex is replaced by the first vertex whose position, normal and UV equal its
//! own as floats.
//!
//! The reference welds in an order of its own, and a welded vertex takes its values from one of its corners.
//! That order matters only where values are not finite or so large that the reference does not weld them; the
//! fast path does not apply to such meshes. (The order also matters for the last edges: see `edge_tail.rs`.)
//! Equal vertices can differ in the sign of a zero, which no result shows: the head of `fast.rs` says why.

use crate::Indices;
use crate::Mesh;
use crate::topology::weld::Bounds;

use crate::exec::simd::Width;
use crate::exec::threads::{self, split_range, split_slice};
use crate::exec::windows::WINDOW;
use crate::tangents::fast::hash_table::{ChainedTable, SeenHashes};
use crate::tangents::fast::triangle_list::WeldMap;
use crate::tangents::fast::vertex_hash::{HashVertices, ValueRange};
use crate::tangents::fast::vertex_record::{VertexSlices, record_of};
use crate::tangents::fast::weld_corners::CornerWeld;
use crate::tangents::fast::worker::Worker;

/// The welded vertices of a mesh. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct HashWeld {
    /// The welded vertex of each corner. Empty where no two vertices are equal.
    welded: Vec<u32>,
    /// The welded vertex of each vertex, where vertices are welded and some are equal; else empty.
    first_equal: Vec<u32>,
    /// True where corners are welded, not vertices.
    per_corner: bool,
    /// The number of welded vertices; where vertices are welded, the number of all vertices.
    pub count: usize,
    /// The number of vertices that equal an earlier one.
    pub copies: usize,
    /// The bounds of all positions, unused ones included.
    pub bounds: Bounds,
    hashes: Vec<u32>,
    /// The vertices with a hash that occurs more than once, by their number in `table`.
    candidates: Vec<u32>,
    table: ChainedTable,
    /// The corners that each thread has welded. The first also has the vertices of all threads.
    corners: Vec<CornerWeld>,
}

/// Corners are welded instead of vertices where there are more vertices per corner: most of them belong to
/// other meshes then.
const MAX_VERTICES_PER_CORNER: usize = 2;

impl HashWeld {
    /// Welds the vertices of an indexed mesh, or the corners of an unindexed one. None where the fast path
    /// does not apply.
    pub fn weld(&mut self, mesh: &Mesh<'_>, width: Width, workers: &mut [Worker]) -> Option<()> {
        self.welded.clear();
        self.first_equal.clear();
        self.copies = 0;
        self.per_corner = matches!(mesh.indices(), Indices::Unindexed)
            || mesh.vertex_count() > MAX_VERTICES_PER_CORNER * mesh.corner_count();
        if self.per_corner {
            return self.weld_corners(mesh, width, workers);
        }
        self.count = mesh.vertex_count();
        match self.find_collisions(mesh, width, workers)? {
            0 => {}
            collisions => self.weld_collisions(mesh, &workers[0].seen_hashes, collisions)?,
        }
        self.find_vertices_of_corners(mesh, workers);
        Some(())
    }

    /// Sets the welded vertex of each vertex of an indexed mesh.
    pub fn set(&mut self, mesh: &Mesh<'_>, welded: Vec<u32>) {
        self.per_corner = false;
        self.count = welded.len();
        self.first_equal = welded;
        self.find_vertices_of_corners(mesh, &mut [()]);
    }

    /// Finds the welded vertex of each corner, where some vertices are equal.
    fn find_vertices_of_corners<W: Send>(&mut self, mesh: &Mesh<'_>, workers: &mut [W]) {
        let count = if self.first_equal.is_empty() { 0 } else { mesh.corner_count() };
        self.welded.resize(count, 0);
        let ranges = split_range(0..count, workers.len(), 1);
        let jobs = ranges.clone().zip(split_slice(&mut self.welded, 0, ranges));
        threads::run(workers, jobs, |_, (range, welded)| match mesh.indices() {
            Indices::U32(indices) => look_up(&self.first_equal, &indices[range], welded),
            Indices::U16(indices) => look_up(&self.first_equal, &indices[range], welded),
            Indices::Unindexed => {}
        });
    }

    pub fn map(&self) -> WeldMap<'_> {
        match (self.per_corner, self.welded.is_empty()) {
            (true, _) => WeldMap::OfCorner(&self.welded, &self.corners[0].distinct.records),
            (false, true) => WeldMap::Unwelded,
            (false, false) => WeldMap::OfVertex(&self.first_equal, &self.welded),
        }
    }

    /// Hashes all vertices, and marks hashes that occur more than once. Returns an upper bound of the number
    /// of vertices that have these.
    ///
    /// Few meshes have equal vertices: with two bits per hash, which stay in the cache, few vertices have to
    /// be compared.
    fn find_collisions(&mut self, mesh: &Mesh<'_>, width: Width, workers: &mut [Worker]) -> Option<usize> {
        self.hashes.resize(self.count, 0);
        let ranges = split_range(0..self.count, workers.len(), 1);
        let jobs = ranges.clone().zip(split_slice(&mut self.hashes, 0, ranges));
        let count = self.count;
        threads::run(workers, jobs, |worker, (range, hashes)| {
            let Worker { value_range, seen_hashes, slices: buffer, .. } = worker;
            *value_range = ValueRange::default();
            seen_hashes.clear(count);
            for (first, hashes) in range.step_by(WINDOW).zip(hashes.chunks_mut(WINDOW)) {
                let slices = VertexSlices::of_vertices(mesh, first..first + hashes.len(), buffer);
                width.run(HashVertices { slices, hashes, value_range });
                seen_hashes.add(hashes);
            }
        });
        let (first, others) = workers.split_first_mut()?;
        others.iter().for_each(|other| first.seen_hashes.merge(&other.seen_hashes));
        self.bounds = ValueRange::bounds(workers.iter().map(|worker| &worker.value_range))?;
        Some(workers[0].seen_hashes.collisions)
    }

    /// Compares the vertices whose hashes occur more than once.
    fn weld_collisions(&mut self, mesh: &Mesh<'_>, seen: &SeenHashes, collisions: usize) -> Option<()> {
        self.table.clear(2 * collisions);
        self.candidates.clear();
        for (vertex, &hash) in (0..).zip(&self.hashes).filter(|(_, hash)| seen.occurs_twice(**hash)) {
            let record = || record_of(mesh, vertex as usize);
            let candidate = |at: u32| self.candidates[at as usize] as usize;
            let is_equal = |at: u32| record_of(mesh, candidate(at)) == record();
            match self.table.find(hash, is_equal).ok()? {
                Some(at) => {
                    if self.first_equal.is_empty() {
                        self.first_equal.extend(0..self.count as u32);
                    }
                    self.first_equal[vertex as usize] = self.candidates[at as usize];
                    self.copies += 1;
                }
                None => {
                    self.table.push(hash);
                    self.candidates.push(vertex);
                }
            }
        }
        Some(())
    }

    /// Welds the corners: each thread those of its own range, then all distinct vertices with those of the
    /// first range.
    fn weld_corners(&mut self, mesh: &Mesh<'_>, width: Width, workers: &mut [Worker]) -> Option<()> {
        self.welded.resize(mesh.corner_count(), 0);
        self.corners.resize_with(workers.len(), CornerWeld::default);
        let ranges = split_range(0..mesh.corner_count(), workers.len(), 1);
        let jobs =
            ranges.clone().zip(split_slice(&mut self.welded, 0, ranges.clone())).zip(&mut self.corners);
        threads::run(workers, jobs, |worker, ((range, welded), corners)| {
            corners.weld(mesh, range, width, &mut worker.slices, welded);
        });
        let (first, later) = self.corners.split_first_mut().expect("one for each worker");
        later.iter_mut().for_each(|later| first.append(later));
        let jobs = split_slice(&mut self.welded, 0, ranges.skip(1)).zip(&*later);
        threads::run(workers, jobs, |_, (welded, later)| later.renumber(welded));
        self.count = first.distinct.records.len();
        self.bounds = ValueRange::bounds(self.corners.iter().map(|corners| &corners.value_range))?;
        if self.corners[0].distinct.has_long_chain { None } else { Some(()) }
    }
}

/// Sets each of `out` to the value at its index.
fn look_up<I: Copy + Into<u32>>(values: &[u32], indices: &[I], out: &mut [u32]) {
    for (out, &index) in out.iter_mut().zip(indices) {
        *out = values[index.into() as usize];
    }
}

//! Welding by hashing: vertices whose position, normal and UV are equal as floats become the first of them.
//!
//! The reference names a welded vertex after one of its corners, in an order of its own. That order can show only where the
//! values are not finite (or so large that it does not weld them), and where equal vertices differ in the sign of a zero; such
//! meshes are refused here. (It shows in one other place, the last run of edges: see `last_run`.)

use crate::Indices;
use crate::Mesh;
use crate::topology::weld::Bounds;

use crate::exec::simd::Width;
use crate::exec::threads::{self, parts, split};
use crate::exec::windows::WINDOW;
use crate::tangents::fast::hash_table::{BitMap, Chains, Crowded, mark_collisions};
use crate::tangents::fast::input::Identity;
use crate::tangents::fast::rows::{Rows, record};
use crate::tangents::fast::vertex_hash::{Hash, Span};
use crate::tangents::fast::weld_corners::{Corners, same};
use crate::tangents::fast::worker::Worker;

/// The welded vertices of a mesh; the memory is kept from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Weld {
    /// By vertex, or by corner; empty when every vertex is its own.
    of: Vec<u32>,
    per_corner: bool,
    /// The number of welded vertices, those that are copies of another or unused included.
    pub count: usize,
    /// How many vertices are copies of another.
    pub copies: usize,
    /// Of all positions, unused ones included.
    pub bounds: Bounds,
    hashes: Vec<u32>,
    seen: BitMap,
    again: BitMap,
    /// The vertices that others can be equal to, by number in `chains`.
    suspects: Vec<u32>,
    chains: Chains,
    /// Those of a mesh that is welded by corners, a stretch per thread; the first has the vertices of all.
    corners: Vec<Corners>,
}

/// The mesh has values that only the reference's own order of vertices decides, or too many of one hash.
pub(crate) struct Refused;

/// Where a mesh has more vertices per corner, most are another mesh's, and the corners are welded instead.
const MOST_PER_CORNER: usize = 2;

impl Weld {
    /// Welds the vertices of an indexed mesh, or the corners of an unindexed one.
    pub fn weld(&mut self, mesh: &Mesh<'_>, width: Width, workers: &mut [Worker]) -> Result<(), Refused> {
        self.of.clear();
        self.copies = 0;
        self.per_corner = matches!(mesh.indices(), Indices::Unindexed)
            || mesh.vertex_count() > MOST_PER_CORNER * mesh.corner_count();
        if self.per_corner {
            return self.weld_corners(mesh, width, workers);
        }
        self.count = mesh.vertex_count();
        let collisions = self.find_collisions(mesh, width, workers)?;
        if collisions > 0 { self.weld_collisions(mesh, collisions) } else { Ok(()) }
    }

    /// Takes the welded vertices of an indexed mesh, found elsewhere.
    pub fn take(&mut self, welded: Vec<u32>) {
        self.per_corner = false;
        self.count = welded.len();
        self.of = welded;
    }

    pub fn identity(&self) -> Identity<'_> {
        match (self.per_corner, self.of.is_empty()) {
            (true, _) => Identity::OfCorner(&self.of, &self.corners[0].distinct.records),
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
        let ranges = split(0..self.count, workers.len(), 1);
        let jobs = ranges.clone().zip(parts(&mut self.hashes, 0, ranges));
        threads::run(workers, jobs, |worker, (range, hashes)| {
            worker.span = Span::default();
            for (first, hashes) in range.step_by(WINDOW).zip(hashes.chunks_mut(WINDOW)) {
                let rows = Rows::new(mesh, first..first + hashes.len(), &mut worker.rows);
                width.run(Hash { rows, hashes, span: &mut worker.span });
            }
        });
        let (hashes, bits) = (&self.hashes[..], self.seen.bits);
        let ranges = split(0..self.seen.words.len(), workers.len(), 1);
        let seen = parts(&mut self.seen.words, 0, ranges.clone());
        let again = parts(&mut self.again.words, 0, ranges.clone());
        threads::run(workers, ranges.zip(seen.zip(again)), |worker, (range, (seen, again))| {
            worker.collisions = mark_collisions(hashes, bits, range.start, seen, again);
        });
        self.bounds = Span::check(workers.iter().map(|worker| &worker.span))?;
        Ok(workers.iter().map(|worker| worker.collisions).sum())
    }

    /// Compares the vertices whose hash values were met more than once.
    fn weld_collisions(&mut self, mesh: &Mesh<'_>, collisions: usize) -> Result<(), Refused> {
        self.chains.clear(2 * collisions);
        self.suspects.clear();
        let mut refused = false;
        for (vertex, &hash) in (0..).zip(&self.hashes).filter(|(_, hash)| self.again.has(**hash)) {
            let here = || record(mesh, vertex as usize);
            let suspect = |at: u32| self.suspects[at as usize] as usize;
            let is_it = |at: u32| record(mesh, suspect(at)) == here();
            match self.chains.find(hash, is_it).map_err(|Crowded| Refused)? {
                Some(at) => {
                    refused |= !same(&record(mesh, suspect(at)), &here());
                    if self.of.is_empty() {
                        self.of.extend(0..self.count as u32);
                    }
                    self.of[vertex as usize] = self.suspects[at as usize];
                    self.copies += 1;
                }
                None => {
                    self.chains.push(hash);
                    self.suspects.push(vertex);
                }
            }
        }
        if refused { Err(Refused) } else { Ok(()) }
    }

    /// Welds the corners: each thread a stretch, then all of these with the first.
    fn weld_corners(&mut self, mesh: &Mesh<'_>, width: Width, workers: &mut [Worker]) -> Result<(), Refused> {
        self.of.resize(mesh.corner_count(), 0);
        self.corners.resize_with(workers.len(), Corners::default);
        let ranges = split(0..mesh.corner_count(), workers.len(), 1);
        let jobs = ranges.clone().zip(parts(&mut self.of, 0, ranges.clone())).zip(&mut self.corners);
        threads::run(workers, jobs, |worker, ((range, of), corners)| {
            corners.weld(mesh, range, width, &mut worker.rows, of);
        });
        let (first, later) = self.corners.split_first_mut().expect("one for each worker");
        later.iter_mut().for_each(|later| first.absorb(later));
        let jobs = parts(&mut self.of, 0, ranges.skip(1)).zip(&*later);
        threads::run(workers, jobs, |_, (of, later)| later.renumber(of));
        self.count = first.distinct.records.len();
        self.bounds = Span::check(self.corners.iter().map(|corners| &corners.span))?;
        if self.corners[0].distinct.refused { Err(Refused) } else { Ok(()) }
    }
}

//! Whole fans: the tangents of vertices around which all triangles share one.
//!
//! MikkTSpace groups the triangles around a vertex by shared edges and UV orientation, splits groups by angle, and sums each
//! part in triangle order. Around nearly every vertex there is one part. So every triangle adds its weighted tangents
//! straight to its vertices, in order, with some marks and a fingerprint of its edges there, and a vertex is decided when these
//! show that its triangles are one part: with certainty where there is one fan of edges, and else wrongly only if 64 bits agree by
//! chance. No edge is looked up. What is not decided is left to the general path.

mod accumulator;
mod angle_bounds;
mod edge_tail;
mod full_frames;
mod hash_table;
mod input;
mod kernel;
mod passes;
mod quads;
mod replay;
mod resume;
mod rows;
mod scattered;
mod second_pass;
mod streamed;
mod vertex_hash;
mod vertex_names;
mod weld_corners;
mod weld_vertices;
mod worker;

use std::ops::Range;

use crate::Mesh;
use crate::math::cosine_of_degrees;
use crate::topology::weld::Bounds;
use crate::util::hash_map::InsertionMap;

use crate::exec::limits::RunLimits;
use crate::exec::simd::Width;
use crate::exec::threads::{self, parts, split};
use crate::exec::windows::{self, Share, Window, overlap, shares};
use crate::tangents::Mode;
use crate::tangents::TangentOptions;
pub use crate::tangents::fast::accumulator::UNDECIDED;
use crate::tangents::fast::accumulator::Vertex;
pub(crate) use crate::tangents::fast::angle_bounds::LARGEST_COSINE;
use crate::tangents::fast::angle_bounds::Spread;
use crate::tangents::fast::edge_tail::{LastRun, Lists, TailCells};
use crate::tangents::fast::full_frames::Sums;
use crate::tangents::fast::input::Source;
use crate::tangents::fast::kernel::Record;
use crate::tangents::fast::passes::{Extent, Special};
use crate::tangents::fast::quads::Cut;
pub(crate) use crate::tangents::fast::quads::triangle_count;
pub(crate) use crate::tangents::fast::replay::PlannedFans;
use crate::tangents::fast::scattered::Terms;
use crate::tangents::fast::streamed::{Stream, Unknown};
use crate::tangents::fast::vertex_names::Names;
use crate::tangents::fast::weld_vertices::{Refused, Weld};
use crate::tangents::fast::worker::Worker;
use crate::topology::edge_sort::TriangleEdge;

/// The memory of a run, kept from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Fans {
    weld: Weld,
    cut: Cut,
    windows: Vec<Window>,
    shares: Vec<Share>,
    workers: Vec<Worker>,
    /// What triangles add, where the tangents' array has no room for it.
    terms: Vec<Terms>,
    /// Faces and corners that need another look.
    special: Special,
    lists: Lists,
    names: Names,
    /// The last edges in the reference's stretches, as the entries where they start, where their order shows.
    tail_runs: Vec<Vec<u32>>,
    /// Of each welded vertex, where whole frames are wanted.
    sums: Vec<Sums>,
    /// Of each welded vertex, where there is an angular threshold,
    spreads: Vec<Spread>,
    /// and whether it is exceeded.
    are_apart: Vec<bool>,
    /// Of each welded vertex, where a plan welds corners.
    records: Vec<Record>,
}

impl Fans {
    /// Writes the tangents of all faces, and lists those with undecided vertices. False where this path does not apply: faces of
    /// other than 3 or 4 corners, values whose weld only the reference's order decides.
    /// `out` is unspecified after cancellation.
    pub fn run(
        &mut self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) -> bool {
        let threads = limits.thread_count(triangle_count(mesh));
        self.workers.resize_with(threads, Worker::default);
        threads::on_pool(threads, || self.run_on(mesh, options, limits, out)).is_ok()
    }

    fn run_on(
        &mut self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) -> Result<(), Refused> {
        self.cut.cut(mesh, limits.width, &mut self.workers)?;
        self.weld.weld(mesh, limits.width, &mut self.workers)?;
        if limits.is_cancelled() {
            return Ok(());
        }
        self.find_windows(mesh, limits.width);
        let tail = TailCells::first(&self.source(mesh), &self.weld.bounds, self.is_shuffled());
        self.add_and_write(mesh, &tail, limits, out);
        self.tail_runs.clear();
        if options.mode != Mode::Corrected && !limits.is_cancelled() {
            self.leave_last_edges(mesh, tail, out);
        }
        let threshold_cosine = cosine_of_degrees(options.threshold);
        if threshold_cosine > -1.0 && !limits.is_cancelled() {
            self.leave_spread(mesh, threshold_cosine, limits, out);
        }
        Ok(())
    }

    /// The mesh that this has just run on, as triangles.
    fn source<'a>(&'a self, mesh: &'a Mesh<'a>) -> Source<'a> {
        source(mesh, &self.weld, &self.cut)
    }

    /// The corners of the faces with undecided vertices, ascending.
    pub fn undecided<'a>(&'a self, mesh: &'a Mesh<'a>) -> impl Iterator<Item = Range<u32>> + Clone {
        let source = self.source(mesh);
        self.special.undecided.iter().map(move |&triangle| source.corners_of_face(triangle))
    }

    /// The last edges, where the order in which the reference leaves them shows: stretches of edges that are matched with each other
    /// only.
    pub fn tail_runs(&self, mesh: &Mesh<'_>) -> Vec<Vec<TriangleEdge>> {
        let source = self.source(mesh);
        let edge = |&entry: &u32| (source.corners(entry / 3), entry % 3);
        self.tail_runs.iter().map(|stretch| stretch.iter().map(edge).collect()).collect()
    }

    /// Finds which vertices each window uses.
    fn find_windows(&mut self, mesh: &Mesh<'_>, width: Width) {
        let source = source(mesh, &self.weld, &self.cut);
        self.windows.clear();
        self.windows.resize(source.window_count(), Window::default());
        let ranges = split(0..self.windows.len(), self.workers.len(), 1);
        let jobs = ranges.clone().zip(parts(&mut self.windows, 0, ranges));
        threads::run(&mut self.workers, jobs, |worker, (range, windows)| {
            for (at, out) in range.zip(windows) {
                let vertices = source.vertices(source.corners_of(at..at + 1), &mut worker.corners);
                width.run(Extent { vertices, lowest: &mut out.lowest, end: &mut out.end });
            }
        });
        windows::look_around(&mut self.windows);
    }

    /// Whether triangles that share vertices are far from each other in the list.
    fn is_shuffled(&self) -> bool {
        self.windows.last().is_some_and(|last| (last.end - last.lowest) as usize > self.weld.count / 4)
    }

    /// Gives each thread its share of the windows, or, where shares would overlap too much, all threads all of them.
    fn add_and_write(
        &mut self,
        mesh: &Mesh<'_>,
        tail: &TailCells,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) {
        self.special.clear();
        self.shares.clear();
        self.shares.extend(shares(&self.windows, self.weld.count, self.workers.len()));
        let shares = &self.shares;
        let (source, windows) = (source(mesh, &self.weld, &self.cut), &self.windows[..]);
        let stream = Stream { source, windows, tail, signs: Unknown, limits };
        if overlap(shares, &self.windows) {
            scattered::run(&stream, self.weld.count, &mut self.workers, &mut self.terms, out);
        } else {
            let ranges = shares.iter().map(|share| source.corners_of(share.windows.clone()));
            let jobs = shares.iter().zip(parts(&mut *out, 0, ranges));
            threads::run(&mut self.workers, jobs, |worker, (share, out)| stream.run(share, worker, out));
            write_pending(&source, shares, &mut self.workers, out);
        }
        self.workers.iter_mut().for_each(|worker| self.special.take(&mut worker.special));
        self.special.settle(&source);
    }

    /// Leaves the vertices of the reference's last edges undecided, where the order of these shows. `tail` is of all vertices, used
    /// or not.
    fn leave_last_edges(&mut self, mesh: &Mesh<'_>, tail: TailCells, out: &mut [[f32; 4]]) {
        let bounds_are_of_used = self.unused_do_not_count();
        let bounds = if bounds_are_of_used { self.weld.bounds } else { bounds_of_used(mesh) };
        let run = LastRun { source: source(mesh, &self.weld, &self.cut), bounds: &bounds };
        let last = if bounds_are_of_used {
            run.find(tail, Some(&self.special.in_tail), &mut self.lists)
        } else {
            let tail = TailCells::first(&run.source, &bounds, self.is_shuffled());
            run.find(tail, None, &mut self.lists)
        };
        if let Some(last) = last {
            let (names, suspects) = (&mut self.names, &self.special.undecided);
            self.tail_runs = names.tail_runs(&run, &last, self.weld.count, suspects);
            self.special.leave(&run.source, names.entries_of(&last.vertices), out);
        }
    }

    /// True when the bounds of all vertices are those of the used ones. A copy of another is not used, and where that one is.
    fn unused_do_not_count(&self) -> bool {
        let unused = self.workers.iter().map(|worker| &worker.unused);
        let count: usize = unused.clone().map(|unused| unused.unseen + unused.count).sum();
        let mut seen = unused.clone().filter(|unused| unused.count > 0);
        count == self.weld.copies
            || unused.clone().all(|unused| unused.unseen == 0)
                && seen.all(|unused| unused.are_inside(&self.weld.bounds))
    }

    /// The welded vertex at each of some corners, named by the first of these.
    pub fn names(&self, mesh: &Mesh<'_>, list: &[u32]) -> Vec<u32> {
        let source = self.source(mesh);
        let mut first = InsertionMap::new();
        let name = |(&corner, at): (&u32, u32)| *first.get_or_insert_with(&[source.vertex(corner)], || at);
        list.iter().zip(0..).map(name).collect()
    }
}

fn source<'a>(mesh: &'a Mesh<'a>, weld: &'a Weld, cut: &'a Cut) -> Source<'a> {
    Source { mesh, identity: weld.identity(), cut }
}

/// The bounds of the positions that corners have.
fn bounds_of_used(mesh: &Mesh<'_>) -> Bounds {
    let mut used = (0..mesh.corner_count()).map(|corner| mesh.positions().get(mesh.vertex_of_corner(corner)));
    Bounds::of(used.next().unwrap_or_default(), used)
}

/// Writes the windows with vertices that several threads have finished.
fn write_pending(source: &Source<'_>, shares: &[Share], workers: &mut [Worker], out: &mut [[f32; 4]]) {
    let mut special = Special::default();
    let mut buffer = Vec::new();
    for &at in workers.iter().flat_map(|worker| &worker.pending) {
        let of = |vertex: u32| {
            let owner = shares.partition_point(|share| share.vertices.end <= vertex as usize);
            workers[owner].vertex(vertex)
        };
        let corners = source.corners_of(at..at + 1);
        let vertices = source.vertices(corners.clone(), &mut buffer);
        if source.is_cut() {
            write_faces::<1>(vertices, corners, of, &mut special, out);
        } else {
            write_faces::<3>(vertices, corners, of, &mut special, out);
        }
    }
    workers[0].special.take(&mut special);
}

/// Writes faces of `N` corners, or corners one after the other. `vertices`: of `corners`.
fn write_faces<'a, const N: usize>(
    vertices: &[u32],
    corners: Range<usize>,
    of: impl Fn(u32) -> &'a Vertex,
    special: &mut Special,
    out: &mut [[f32; 4]],
) {
    let faces = vertices.as_chunks::<N>().0.iter().zip(out[corners.clone()].as_chunks_mut().0);
    for ((vertices, out), face) in faces.zip((corners.start / N) as u32..) {
        let vertices = vertices.map(&of);
        *out = vertices.map(|vertex| vertex.sum);
        special.note(face, vertices.map(Vertex::position), out);
    }
}

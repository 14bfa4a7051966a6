//! The fast path of MikkTSpace: the tangents of vertices around which all triangles share one.

mod accumulator;
mod angle_bounds;
mod edge_tail;
mod exceptions;
mod full_frames;
mod hash_table;
mod kernel;
mod passes;
mod proof;
mod quads;
mod replay;
mod resume;
mod scattered;
mod schedule;
mod second_pass;
mod state;
mod streamed;
mod triangle_list;
mod vertex_hash;
mod vertex_names;
mod vertex_record;
mod weld_corners;
mod weld_vertices;
mod worker;

use crate::Frame;
use crate::Mesh;
use crate::math::cosine_of_degrees;
use crate::topology::weld::Bounds;

use crate::exec::limits::RunLimits;
use crate::exec::threads;
pub(crate) use crate::tangents::fast::angle_bounds::LARGEST_COSINE;
use crate::tangents::fast::edge_tail::TailCells;
use crate::tangents::fast::passes::{Discover, PassInput};
pub use crate::tangents::fast::proof::UNDECIDED;
pub(crate) use crate::tangents::fast::quads::triangle_count;
pub(crate) use crate::tangents::fast::replay::FastPlan;
use crate::tangents::fast::schedule::find_windows;
use crate::tangents::fast::second_pass::SecondPass;
pub(crate) use crate::tangents::fast::state::FastPath;
use crate::tangents::fast::state::triangle_list;
use crate::tangents::fast::worker::Worker;
use crate::tangents::options::{Mode, TangentOptions};

impl FastPath {
    /// Writes the tangents of all decided vertices, and lists the faces with undecided vertices, whose tangents have the sign
    /// [`UNDECIDED`].
    ///
    /// Returns false where the fast path does not apply: faces of other than 3 or 4 corners, values that only the reference's order
    /// welds. The tangents are unspecified after cancellation.
    pub fn run(
        &mut self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) -> bool {
        let threads = limits.thread_count(triangle_count(mesh));
        self.workers.resize_with(threads, Worker::default);
        threads::on_pool(threads, || self.run_stages(mesh, options, limits, out)).is_some()
    }

    fn run_stages(
        &mut self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) -> Option<()> {
        self.split.split(mesh, limits.width, self.workers.len())?;
        self.weld.weld(mesh, limits.width, &mut self.workers)?;
        if limits.is_cancelled() {
            return Some(());
        }
        let list = triangle_list(mesh, &self.weld, &self.split);
        find_windows(&list, limits.width, &mut self.workers, &mut self.windows);
        let tail = TailCells::first(&list, &self.weld.bounds, self.is_shuffled());
        self.discover(mesh, &tail, limits, out);
        self.tail_runs.clear();
        if options.mode != Mode::Corrected && !limits.is_cancelled() {
            self.search_last_edges(mesh, tail, out);
        }
        let threshold_cosine = cosine_of_degrees(options.threshold);
        if threshold_cosine > -1.0 && !limits.is_cancelled() {
            self.apply_threshold(mesh, threshold_cosine, limits, out);
        }
        Some(())
    }

    /// True where triangles that share vertices are far apart in the list.
    fn is_shuffled(&self) -> bool {
        self.windows.last().is_some_and(|last| last.vertices.len() > self.weld.count / 4)
    }

    /// Adds all triangles to their vertices, decides the vertices, and writes the corners.
    fn discover(&mut self, mesh: &Mesh<'_>, tail: &TailCells, limits: RunLimits<'_>, out: &mut [[f32; 4]]) {
        let list = triangle_list(mesh, &self.weld, &self.split);
        let input = PassInput { list, windows: &self.windows, pass: Discover { tail }, limits };
        self.exceptions.clear();
        self.schedule.run(&input, self.weld.count, &mut self.workers, out);
        self.workers.iter_mut().for_each(|worker| self.exceptions.append(&mut worker.exceptions));
        self.exceptions.settle(&list);
    }

    /// Makes the vertices of the reference's last edges undecided, where the order of these edges changes the result. `tail`: its cells
    /// are those of all vertices, used or not.
    fn search_last_edges(&mut self, mesh: &Mesh<'_>, tail: TailCells, out: &mut [[f32; 4]]) {
        if self.bounds_are_of_used_vertices() {
            let bounds = self.weld.bounds;
            self.undecide_last_edges(mesh, &bounds, tail, true, out);
        } else {
            let bounds = bounds_of_used_vertices(mesh);
            let tail = TailCells::first(&self.list(mesh), &bounds, self.is_shuffled());
            self.undecide_last_edges(mesh, &bounds, tail, false, out);
        }
    }

    /// True when the bounds of all vertices are certainly those of the used ones. A copy of another vertex counts as unused, and lies
    /// where that one lies.
    fn bounds_are_of_used_vertices(&self) -> bool {
        let unused = self.workers.iter().map(|worker| &worker.findings.unused);
        let count: usize = unused.clone().map(|unused| unused.unread + unused.count).sum();
        let mut with_bounds = unused.clone().filter(|unused| unused.count > 0);
        count == self.weld.copies
            || unused.clone().all(|unused| unused.unread == 0)
                && with_bounds.all(|unused| unused.are_inside(&self.weld.bounds))
    }

    /// Makes vertices undecided whose triangles may differ by the threshold.
    fn apply_threshold(
        &mut self,
        mesh: &Mesh<'_>,
        threshold_cosine: f32,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) {
        let mut angle_bounds = std::mem::take(&mut self.angle_bounds);
        let mut exceptions = std::mem::take(&mut self.exceptions);
        let pass = self.second_pass(mesh, limits);
        angle_bounds.undecide_wide_vertices(pass, threshold_cosine, &mut exceptions, out);
        (self.angle_bounds, self.exceptions) = (angle_bounds, exceptions);
    }

    /// Computes the bitangents and magnitudes of all vertices of the mesh of the last run.
    pub fn add_frames(&mut self, mesh: &Mesh<'_>, limits: RunLimits<'_>) {
        let mut full_frames = std::mem::take(&mut self.full_frames);
        full_frames.compute(self.second_pass(mesh, limits));
        self.full_frames = full_frames;
    }

    /// Writes the bitangents and magnitudes of corners of the mesh of the last run, the first of which is corner number `first`. They are
    /// unspecified where the tangent is undecided.
    pub fn write_rest(&self, mesh: &Mesh<'_>, first: usize, out: &mut [Frame]) {
        self.full_frames.write(&self.list(mesh), first, out);
    }

    fn second_pass<'a>(&'a mut self, mesh: &'a Mesh<'a>, limits: RunLimits<'a>) -> SecondPass<'a> {
        let Self { weld, split, windows, schedule, workers, .. } = self;
        let (list, vertex_count) = (triangle_list(mesh, weld, split), weld.count);
        SecondPass { list, windows, schedule, workers, vertex_count, limits }
    }
}

/// The bounds of the positions of all corners.
fn bounds_of_used_vertices(mesh: &Mesh<'_>) -> Bounds {
    let mut used = (0..mesh.corner_count()).map(|corner| mesh.positions().get(mesh.vertex_of_corner(corner)));
    Bounds::of(used.next().unwrap_or_default(), used)
}

//! The fast path of MikkTSpace: computes the tangents of vertices around which all triangles share one
//! tangent.
//!
//! The reference finds the neighbours of every triangle through shared edges, joins the triangles around a
//! vertex that are connected by edges and have one UV orientation into groups, splits groups by angle into
//! subgroups, and gives the corners of a subgroup one tangent: the sum, in the order of the triangle list, of
//! the triangles' unit tangents weighted by corner angle. Around nearly every vertex of a real
//! mesh all triangles form one subgroup. There, the sum over *all* triangles is that sum, with equal bits. So
//! the fast path adds every triangle to its vertices without looking up an edge, and proves afterwards for
//! which vertices this was right. For the others, which are *undecided*, it finds the groups around each
//! vertex from the triangles around it (`resolve.rs`). What is left then goes through the general path
//! (`submesh.rs`): unusable tangents that a mode repairs, large groups with opposite directions.
//!
//! ```text
//! split quads into triangles                                                  quads.rs
//! weld equal vertices by hashing, or corners where there are no indices       weld_vertices.rs, weld_corners.rs
//! find which vertices every window of 1024 triangles uses                     schedule.rs
//! for each triangle, in order, 64 at a time:                                  passes.rs, kernel.rs
//!     compute dP/du, dP/dv and the angles of its corners
//!     for each corner, v its vertex:                                          accumulator.rs
//!         sum[v]         += corner angle * unit tangent in the plane of the normal
//!         marks[v]       |= UV orientation, signs of the directions' components, rays in the corner's wedge
//!         rays[v]        += 1 if the corner's wedge in UV space holds the ray +u
//!         fingerprint[v] += f(next vertex of the triangle) - f(previous vertex)
//! for each vertex v to which all its triangles have been added:               proof.rs, open_rows.rs
//!     if one orientation and nothing opposite and one fan and the tangent needs no repair:
//!         tangent[v] = normalize(sum[v]), with the sign of the orientation
//!     else if no triangle has UV area: tangent[v] = the default
//!     else: v is undecided
//! copy the tangents of vertices to corners, list the faces of undecided ones  exceptions.rs
//! unless the mode corrects edges:                                             edge_tail.rs, tail_names.rs, vertex_names.rs
//!     make vertices of the reference's last edges undecided where the order of these edges matters
//! if the angular threshold is below 180 degrees:                              angle_bounds.rs
//!     make vertices undecided whose tangents or bitangents may differ by the threshold
//! match the edges at each undecided vertex, find its groups                   undecided.rs, fans.rs
//! add the triangles again, to groups instead of vertices                      resolve.rs
//! ```
//!
//! # Why the tests suffice
//!
//! A decided vertex passes three tests, which together say that its triangles are one subgroup.
//!
//! - **One orientation.** Exactly one of `PRESERVES` and `MIRRORS` is marked, and no `NEEDS_GENERAL_PATH`: no
//!   triangle is degenerate, has no UV area, or has so little that rounding could have changed its sign.
//!   Proof: the reference makes groups of triangles of one orientation, the sign of the same expression; only
//!   triangles without UV area can join groups of either.
//! - **Nothing opposite.** All tangents have a component above 1/16 on one axis, or all have one below -1/16;
//!   the bitangents likewise. Proof: at 180 degrees the reference separates triangles whose tangents or
//!   bitangents have a dot product of -1 or less, and two unit vectors with such components have one of at
//!   least 1/256 - (1 - 1/256) = -1 + 2/256.
//! - **One fan.** The triangles are connected by edges at the vertex. Let f(x) be the number of vertex x, its
//!   square and 64 bits of a keyed hash. A triangle adds f(next) - f(previous); at an edge that two triangles
//!   share, the terms cancel. So the sum is zero when every edge is shared, that is, when the triangles form
//!   closed loops, and f(a) - f(b) when one open row from a to b is left besides. Every closed loop of
//!   triangles of one orientation turns around the vertex in UV space at least once, so each ray is in a
//!   wedge of it. Sum zero and the ray +u in one wedge: one loop. Sum f(a) - f(b) and one of the rays +u, -u,
//!   +v, -v in no wedge: one row. The numbers of a and b follow from their difference and that of their
//!   squares, but for a few candidates, which are sums of two numbers below the number of vertices.
//!
//! A block of triangles of which each is marked as trouble adds its marks alone: all of its vertices are
//! undecided or have no UV area around them, and nothing reads their sums.
//!
//! The first two tests are certain. The third is certain for a fan, and can be wrong for a vertex of several
//! fans whose terms cancel by chance. Numbers and squares can be made to cancel; the hash has a random key,
//! drawn when the program first needs it, so that a mesh cannot be made for it. Of a random function, 64 bits
//! would cancel with a probability of 2^-64 for a vertex whose sum is zero or determines a and b,
//! and of at most 2^-58 where a - b has so many factors of two that up to 64 pairs are tried. The hash is no
//! random function, and we have no proof of a bound for it. Measured: in 420 million pairs of a random key
//! and four, six or eight regularly spaced vertices whose numbers and squares cancel, the two hashes of 32
//! bits cancelled twice and once, and never both; random functions are expected to cancel 0.1 times each.
//! (With a known key, twenty triangles that are twenty fans and pass the test were found by lattice reduction
//! in a second.)
//!
//! # Why groups can be found vertex by vertex
//!
//! - **Edges.** The reference sorts the half-edges by vertices and then by triangle, and matches each with
//!   the first unmatched one between the same vertices that runs the opposite way. So which half-edges match
//!   depends on the half-edges between these two vertices and on the order of their triangles, and on nothing
//!   else. All of them are around either vertex. This holds for edges of any number of triangles; the
//!   exception are the reference's last edges, whose runs are found first. Among all half-edges between a
//!   vertex and another, the first that leaves matches the first that comes back, the second the second:
//!   unmatched ones all run one way. So a triangle has at most two neighbours around a vertex, and a group is
//!   a row or a loop of them.
//! - **Groups.** A group is a flood fill around its vertex, from triangle to triangle across matched edges,
//!   where the orientation is equal. Triangles without UV area take part in one more decision, which is not
//!   local: each adopts the orientation of the first group that reaches it at any of its vertices. So where
//!   there is such a triangle, the fills run in the reference's order, by their first triangles. All vertices
//!   of such a triangle are undecided, so no fill that could reach it is missing, but for those around which
//!   no triangle has UV area: no fill starts there, since fills start from triangles with UV area alone.
//!   Their corners keep the default, which the first pass writes.
//! - **Sums.** All members of a group join when nothing is opposite (the test above, on the marks of the
//!   members alone). The group's sum is the sum of its triangles in their order, and the terms come from the
//!   same kernel. Triangles without UV area add nothing. Where the test fails, or the threshold is smaller,
//!   all pairs of members are compared as the reference compares them (`pairs.rs`).
//! - **Copies.** A corner of a degenerate triangle takes the tangent of the first other corner at its vertex.
//! - **Quads.** Both halves take one orientation before groups are found, and join each other. A corner on
//!   the diagonal is in two triangles: where one of them is in no group, the other's counts; where their
//!   groups differ, the vertex is left to the general path, which averages.
//!
//! A vertex whose tangent has to be repaired stays undecided, and so does one with too many triangles for
//! pairs. The general path then groups these vertices anew. Their groups depend on those of other vertices
//! through triangles without UV area and through degenerate triangles only, so the vertices of such triangles
//! that have groups are left to it as well.
//!
//! [`Mode::Corrected`] gives all corners of a face one sign. The default of a vertex around which no triangle
//! has UV area has the sign -1, so in this mode such a vertex is made undecided again where one of its faces
//! has a corner that is undecided or has the sign +1. At all others the signs of every face are equal, and
//! nothing is unified.
//!
//! # Where the fast path does not apply
//!
//! The whole mesh takes the general path where the reference's own order of vertices decides: values that are
//! not finite or above 1e38, more than 256 vertices of one hash. So do faces of other than 3 or 4 corners,
//! and thresholds below about 0.36 degrees.
//!
//! # Equal vertices that differ in the sign of a zero
//!
//! The reference reads the values of one of them, and it does not matter which. With a zero of the other
//! sign, sums, products and square roots change in the sign of a zero at most, comparisons and arccosines do
//! not change at all, and nothing is divided by a zero. A tangent is a sum that starts at +0, times a
//! positive factor, and no addition turns +0 into -0. So the sign of a zero in the input reaches no result.
//! (Repairs read the normals of corners, not those of welded vertices.)
//!
//! # Memory and threads
//!
//! A vertex is one cache line. It is read when the first window that uses it begins, finished when the last
//! has ended, written to its corners then, and dropped, so that a mesh in a sensible order stays in the cache
//! from the first access to the output (`streamed.rs`). Each thread streams its own windows; triangles at the
//! border of two threads are added by both. Where triangles that share vertices are far apart in the
//! list, all threads share all windows instead (`scattered.rs`). A plan repeats the sums alone (`replay.rs`),
//! the bitangents of full frames are added together with the tangents (`full_frames.rs`), and a GPU can take
//! the place of the main pass (`resume.rs`). Measurements and failed attempts are in docs/notes/speed.md.

mod accumulator;
mod angle_bounds;
mod edge_tail;
mod exceptions;
mod fans;
mod full_frames;
mod hash_table;
mod kernel;
mod open_rows;
mod pairs;
mod passes;
mod planned_groups;
mod proof;
mod quads;
mod replay;
mod resolve;
mod resolve_run;
mod resume;
mod scattered;
mod schedule;
mod second_pass;
mod state;
mod streamed;
mod tail_names;
mod triangle_list;
mod undecided;
mod vertex_hash;
mod vertex_names;
mod vertex_quantity;
mod vertex_record;
mod weld_corners;
mod weld_vertices;
mod worker;

use std::marker::PhantomData;

use crate::Frame;
use crate::Mesh;
use crate::math::cosine_of_degrees;
use crate::topology::weld::Bounds;

use crate::exec::limits::RunLimits;
use crate::tangents::fast::angle_bounds::LARGEST_COSINE;
use crate::tangents::fast::edge_tail::TailCells;
use crate::tangents::fast::passes::{Discover, PassInput};
pub use crate::tangents::fast::proof::UNDECIDED;
pub(crate) use crate::tangents::fast::quads::triangle_count;
pub(crate) use crate::tangents::fast::replay::FastPlan;
use crate::tangents::fast::schedule::find_windows;
use crate::tangents::fast::second_pass::SecondPass;
pub(crate) use crate::tangents::fast::state::FastPath;
use crate::tangents::fast::state::triangle_list;
use crate::tangents::fast::vertex_quantity::VertexQuantity;
use crate::tangents::fast::worker::{Findings, Worker};
use crate::tangents::mikktspace::raw_frames::DEFAULT_FRAME;
use crate::tangents::options::{MikkTSpaceOptions, Mode};

impl FastPath {
    /// Writes the tangents of all decided vertices, and lists the faces with undecided vertices, whose
    /// tangents have the sign [`UNDECIDED`].
    ///
    /// Returns false where the fast path does not apply: faces of other than 3 or 4 corners, values that only
    /// the reference's order welds, thresholds so small that nearly all vertices would be undecided. The
    /// tangents are unspecified after cancellation.
    pub fn run(
        &mut self,
        mesh: &Mesh<'_>,
        options: &MikkTSpaceOptions,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) -> bool {
        self.run_stages::<()>(mesh, options, limits, true, &mut Vec::new(), out).is_some()
    }

    /// As [`FastPath::run`] for a plan, which adds up the tangent of every decided vertex again: vertices
    /// whose triangles have no UV area stay undecided.
    pub fn run_for_plan(
        &mut self,
        mesh: &Mesh<'_>,
        options: &MikkTSpaceOptions,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) -> bool {
        self.run_stages::<()>(mesh, options, limits, false, &mut Vec::new(), out).is_some()
    }

    /// As [`FastPath::run`], and computes the bitangents and magnitudes of all vertices.
    pub fn run_with_bitangents(
        &mut self,
        mesh: &Mesh<'_>,
        options: &MikkTSpaceOptions,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) -> bool {
        let mut full_frames = std::mem::take(&mut self.full_frames);
        let applies = self.run_stages(mesh, options, limits, true, full_frames.quantities(), out).is_some();
        if applies && self.schedule.is_scattered(&self.windows) && !limits.is_cancelled() {
            full_frames.compute(self.second_pass(mesh, limits));
        }
        full_frames.set_defaults(&self.flat_vertices);
        self.full_frames = full_frames;
        applies
    }

    /// `quantities`: receives one element per welded vertex; they are unspecified where the pass was
    /// scattered.
    fn run_stages<Q: VertexQuantity>(
        &mut self,
        mesh: &Mesh<'_>,
        options: &MikkTSpaceOptions,
        limits: RunLimits<'_>,
        decides_flat: bool,
        quantities: &mut Vec<Q>,
        out: &mut [[f32; 4]],
    ) -> Option<()> {
        let threads = limits.thread_count(triangle_count(mesh));
        self.workers.resize_with(threads, Worker::default);
        // Those of an earlier mesh, where this one ends before the pass.
        self.flat_vertices.clear();
        let threshold_cosine = cosine_of_degrees(options.threshold);
        if threshold_cosine >= LARGEST_COSINE || threshold_cosine.is_nan() {
            return None;
        }
        self.split.split(mesh, limits.width, self.workers.len())?;
        if limits.is_cancelled() {
            return Some(());
        }
        self.weld.weld(mesh, limits.width, &mut self.workers)?;
        if limits.is_cancelled() {
            return Some(());
        }
        let list = triangle_list(mesh, &self.weld, &self.split);
        find_windows(&list, limits.width, &mut self.workers, &mut self.windows);
        let tail = TailCells::first(&list, &self.weld.bounds, self.is_shuffled());
        self.discover(mesh, (&tail, decides_flat), limits, quantities, out);
        if options.mode == Mode::Corrected && self.flat_signs_may_change(mesh) && !limits.is_cancelled() {
            self.undecide_flat_vertices_of_mixed_faces(mesh, out);
        }
        self.tail_runs.clear();
        // Where no triangle has UV area there are no groups, whatever the order of edges.
        let has_groups = self.flat_triangles < triangle_count(mesh);
        if has_groups && options.mode != Mode::Corrected && !limits.is_cancelled() {
            self.search_last_edges(mesh, tail, out);
        }
        if has_groups && threshold_cosine > -1.0 && !limits.is_cancelled() {
            self.apply_threshold(mesh, threshold_cosine, limits, out);
        }
        Some(())
    }

    /// True where vertices were decided because their triangles have no UV area, and one of these may have a
    /// corner of the other sign, which [`Mode::Corrected`] unifies: not all triangles are without UV
    /// area.
    fn flat_signs_may_change(&self, mesh: &Mesh<'_>) -> bool {
        self.flat_triangles < triangle_count(mesh) && !self.flat_vertices.is_empty()
    }

    /// Makes the vertices undecided that were decided because their triangles have no UV area, and that have
    /// a face with a corner of another sign or an undecided one.
    fn undecide_flat_vertices_of_mixed_faces(&mut self, mesh: &Mesh<'_>, out: &mut [[f32; 4]]) {
        let Self { weld, split, exceptions, flat_vertices, .. } = self;
        let list = triangle_list(mesh, weld, split);
        let mut is_flat = vec![false; weld.count];
        flat_vertices.iter().for_each(|&vertex| is_flat[vertex as usize] = true);
        let mut is_mixed = vec![false; weld.count];
        for corners in mesh.face_ranges() {
            if out[corners.clone()].iter().any(|corner| corner[3] != DEFAULT_FRAME.sign) {
                for vertex in corners.map(|corner| list.vertex(corner as u32) as usize) {
                    is_mixed[vertex] |= is_flat[vertex];
                }
            }
        }
        flat_vertices.retain(|&vertex| !is_mixed[vertex as usize]);
        let entries = 0..3 * list.count() as u32;
        let is_undecided = |entry: &u32| is_mixed[list.vertex(list.corner(*entry)) as usize];
        exceptions.undecide(&list, entries.filter(is_undecided), out);
    }

    /// True where triangles that share vertices are far apart in the list.
    fn is_shuffled(&self) -> bool {
        self.windows.last().is_some_and(|last| last.vertices.len() > self.weld.count / 4)
    }

    /// Adds all triangles to their vertices, decides the vertices, and writes the corners.
    fn discover<Q: VertexQuantity>(
        &mut self,
        mesh: &Mesh<'_>,
        (tail, decides_flat): (&TailCells, bool),
        limits: RunLimits<'_>,
        quantities: &mut Vec<Q>,
        out: &mut [[f32; 4]],
    ) {
        let list = triangle_list(mesh, &self.weld, &self.split);
        let vertex_count = self.weld.count as u32;
        let pass = Discover { tail, decides_flat, vertex_count, quantity: PhantomData };
        let input = PassInput { list, windows: &self.windows, pass, limits };
        self.exceptions.clear();
        quantities.clear();
        quantities.resize(self.weld.count, Q::default());
        self.schedule.run(&input, &mut self.workers, quantities, out);
        self.flat_vertices.clear();
        for worker in &mut self.workers {
            self.exceptions.append(&mut worker.exceptions);
            self.flat_vertices.extend(&worker.findings.flat_vertices);
        }
        self.exceptions.sort(&list);
        self.flat_triangles = self.workers.iter().map(|worker| worker.block.flat_triangles).sum();
    }

    /// Makes the vertices of the reference's last edges undecided, where the order of these edges changes the
    /// result. `tail`: its cells are those of all vertices, used or not.
    fn search_last_edges(&mut self, mesh: &Mesh<'_>, tail: TailCells, out: &mut [[f32; 4]]) {
        if self.bounds_are_of_used_vertices() {
            let bounds = self.weld.bounds;
            self.undecide_last_edges(mesh, &bounds, &tail, true, out);
        } else {
            let bounds = bounds_of_used_vertices(mesh);
            let tail = TailCells::first(&self.list(mesh), &bounds, self.is_shuffled());
            self.undecide_last_edges(mesh, &bounds, &tail, false, out);
        }
    }

    /// True when the bounds of all vertices are certainly those of the used ones. A copy of another vertex
    /// counts as unused, and lies where that one lies.
    fn bounds_are_of_used_vertices(&self) -> bool {
        let findings = self.workers.iter().map(|worker| &worker.findings);
        let unused: usize = findings.clone().map(|findings| findings.unread + findings.unused).sum();
        let are_inside =
            |findings: &Findings| findings.unread == 0 && findings.unused_are_inside(&self.weld.bounds);
        unused == self.weld.copies || findings.clone().all(are_inside)
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
        let flat_vertices = std::mem::take(&mut self.flat_vertices);
        let pass = (self.second_pass(mesh, limits), &flat_vertices[..]);
        angle_bounds.undecide_wide_vertices(pass, threshold_cosine, &mut exceptions, out);
        (self.angle_bounds, self.exceptions, self.flat_vertices) = (angle_bounds, exceptions, flat_vertices);
    }

    /// Writes the bitangents and magnitudes of corners of the mesh of the last run, the first of which is
    /// corner number `first`. They are unspecified where the tangent is undecided.
    pub fn write_bitangents(&self, mesh: &Mesh<'_>, first: usize, out: &mut [Frame]) {
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

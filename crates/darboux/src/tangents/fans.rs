//! Whole fans: the tangents of vertices around which all triangles certainly share one.
//!
//! MikkTSpace groups the triangles around a vertex by shared edges and UV orientation, splits groups by angle, and sums each
//! part in triangle order. Around nearly every vertex there is one part. So every triangle adds its weighted tangents
//! straight to its vertices, in order, with some marks and a fingerprint of its edges there, and a vertex is decided when these
//! prove that its triangles are one part. No edge is looked up. What is not decided is left to the general path.

mod block;
mod last_run;
mod source;
mod steps;
mod vertices;
mod weld;
mod width;
mod workers;

use std::ops::Range;

use crate::weld::Bounds;
use crate::{Faces, Mesh};

use super::Mode;
use last_run::{LastRun, TailCells};
use source::{Rows, triangles};
use steps::{Add, Collect, Evaluate, Extent, Finish, Read, Special, Write};
pub(super) use vertices::UNDECIDED;
use vertices::Vertex;
use weld::{Refused, Weld};
pub(crate) use width::Width;
pub use width::WidthLimit;
use workers::{Worker, parts, split};

/// Triangles per window: vertices are read when the first window that uses them begins, and finished when the last has ended.
const WINDOW: usize = if cfg!(small_limits) { 2 } else { 1024 };

/// Windows per thread that are added up at once, where there are several threads.
const WINDOWS_AT_ONCE: usize = if cfg!(small_limits) { 2 } else { 64 };

/// The memory of a run, kept from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Fans {
    vertices: Vec<Vertex>,
    /// What the corners of each vertex say of it.
    marks: Vec<u32>,
    weld: Weld,
    windows: Vec<Window>,
    workers: Vec<Worker>,
    pub special: Special,
}

/// A window's vertices, the lowest of all windows from it on, and the end of those of all up to it.
#[derive(Clone, Copy, Debug, Default)]
struct Window {
    lowest: u32,
    end: u32,
    lowest_from_here: u32,
    end_up_to_here: u32,
}

impl Fans {
    /// Writes the tangents of all triangles, and lists those with undecided vertices. False where this path does not apply:
    /// faces that are not triangles, values whose weld only the reference's order decides, last edges whose order could show.
    pub fn run(&mut self, mesh: &Mesh<'_>, mode: Mode, width: Width, out: &mut [[f32; 4]]) -> bool {
        if !matches!(mesh.faces(), Faces::Triangles) {
            return false;
        }
        self.workers.resize_with(workers::threads(mesh.face_count()), Worker::default);
        if let Err(Refused) = self.weld.weld(mesh, width, &mut self.workers, &mut self.vertices) {
            return false;
        }
        self.find_windows(mesh, width);
        let tail = TailCells::first(mesh, self.weld.identity(), &self.weld.bounds, self.is_shuffled());
        self.stream(mesh, &tail, width, out);
        mode == Mode::Corrected || !self.last_run_could_show(mesh, tail)
    }

    /// Finds which vertices each window uses.
    fn find_windows(&mut self, mesh: &Mesh<'_>, width: Width) {
        self.windows.clear();
        self.windows.resize(mesh.face_count().div_ceil(WINDOW), Window::default());
        let identity = self.weld.identity();
        let ranges = split(0..self.windows.len(), self.workers.len(), 1);
        let jobs = ranges.clone().zip(parts(&mut self.windows, 0, ranges));
        workers::run(&mut self.workers, jobs, |worker, (range, windows)| {
            for (at, out) in range.zip(windows) {
                let triangles =
                    triangles(mesh, identity, window(at, mesh.face_count()), &mut worker.triangles);
                width.run(Extent { triangles, lowest: &mut out.lowest, end: &mut out.end });
            }
        });
        let mut end = 0;
        for window in &mut self.windows {
            end = window.end.max(end);
            window.end_up_to_here = end;
        }
        let mut lowest = u32::MAX;
        for window in self.windows.iter_mut().rev() {
            lowest = window.lowest.min(lowest);
            window.lowest_from_here = lowest;
        }
    }

    /// Whether triangles that share vertices are far from each other in the list.
    fn is_shuffled(&self) -> bool {
        self.windows.last().is_some_and(|last| (last.end - last.lowest) as usize > self.weld.count / 4)
    }

    /// Goes through the windows: reads what each needs first, adds it up, finishes what none needs any more, writes it.
    fn stream(&mut self, mesh: &Mesh<'_>, tail: &TailCells, width: Width, out: &mut [[f32; 4]]) {
        self.special.clear();
        self.marks.resize(self.weld.count, 0);
        self.workers.iter_mut().for_each(|worker| worker.all_used = true);
        let (mut read, mut finished, mut written) = (0, 0, 0);
        if !self.weld.is_per_vertex() {
            self.mark_vertices(tail);
            read = self.weld.count;
        }
        let threads = self.workers.len();
        let at_once = if threads > 1 { threads * WINDOWS_AT_ONCE } else { 1 };
        for first in (0..self.windows.len()).step_by(at_once) {
            let next = (first + at_once).min(self.windows.len());
            let end = (self.windows[next - 1].end_up_to_here as usize).max(read);
            self.read(mesh, tail, read..end, width);
            read = end;
            self.add(mesh, first..next, width, out);
            let unfinished = self.windows.get(next).map_or(read, |next| next.lowest_from_here as usize);
            let end = unfinished.min(read).max(finished);
            self.finish(finished..end, width);
            finished = end;
            let complete = |window: &&Window| window.end as usize <= finished;
            let end = written + self.windows[written..next].iter().take_while(complete).count();
            self.write(mesh, written..end, width, out);
            written = end;
        }
    }

    fn mark_vertices(&mut self, tail: &TailCells) {
        for (marks, vertex) in self.marks.iter_mut().zip(&self.vertices) {
            *marks = tail.mark(vertex.position());
        }
    }

    /// Makes vertices of the mesh's.
    fn read(&mut self, mesh: &Mesh<'_>, tail: &TailCells, range: Range<usize>, width: Width) {
        let ranges = split(range, self.workers.len(), 1);
        let vertices = parts(&mut self.vertices, 0, ranges.clone());
        let marks = parts(&mut self.marks, 0, ranges.clone());
        workers::run(
            &mut self.workers,
            ranges.zip(vertices).zip(marks),
            |worker, ((range, vertices), marks)| {
                let stretches =
                    range.step_by(WINDOW).zip(vertices.chunks_mut(WINDOW)).zip(marks.chunks_mut(WINDOW));
                for ((first, vertices), marks) in stretches {
                    let rows = Rows::new(mesh, first..first + vertices.len(), &mut worker.rows);
                    width.run(Read { rows, tail, vertices, marks });
                }
            },
        );
    }

    /// Adds windows to their vertices.
    fn add(&mut self, mesh: &Mesh<'_>, windows: Range<usize>, width: Width, out: &mut [[f32; 4]]) {
        let identity = self.weld.identity();
        if let [worker] = &mut self.workers[..] {
            let (vertices, marks) = (&mut self.vertices, &mut self.marks);
            for at in windows {
                let triangles =
                    triangles(mesh, identity, window(at, mesh.face_count()), &mut worker.triangles);
                width.run(Add { triangles, block: &mut worker.block, vertices, marks });
            }
            return;
        }
        self.evaluate(mesh, windows.clone(), width, out);
        self.collect(mesh, windows, width, out);
    }

    /// Writes what corners add to their vertices to the corners' place in `out`: each thread its part of the triangles.
    fn evaluate(&mut self, mesh: &Mesh<'_>, windows: Range<usize>, width: Width, out: &mut [[f32; 4]]) {
        let (identity, vertices) = (self.weld.identity(), &self.vertices[..]);
        let ranges = split(triangles_of(windows, mesh), self.workers.len(), WINDOW);
        let out = parts(out.as_chunks_mut::<3>().0, 0, ranges.clone());
        workers::run(&mut self.workers, ranges.zip(out), |worker, (range, out)| {
            let starts = range.step_by(WINDOW);
            for (first, out) in starts.zip(out.chunks_mut(WINDOW)) {
                let triangles = triangles(mesh, identity, first..first + out.len(), &mut worker.triangles);
                width.run(Evaluate { triangles, block: &mut worker.block, vertices, out });
            }
        });
    }

    /// Adds what was written to `out`: each thread to its part of the vertices, in triangle order.
    fn collect(&mut self, mesh: &Mesh<'_>, windows: Range<usize>, width: Width, out: &[[f32; 4]]) {
        let (identity, terms) = (self.weld.identity(), out.as_chunks::<3>().0);
        let lowest = self.windows[windows.clone()].iter().map(|window| window.lowest).min().unwrap_or(0);
        let end = self.windows[windows.clone()].iter().map(|window| window.end).max().unwrap_or(0);
        let ranges = split(lowest as usize..end as usize, self.workers.len(), 1);
        let vertices = parts(&mut self.vertices, 0, ranges.clone());
        let marks = parts(&mut self.marks, 0, ranges.clone());
        let all = &self.windows[..];
        workers::run(
            &mut self.workers,
            ranges.zip(vertices).zip(marks),
            |worker, ((range, vertices), marks)| {
                let meets = |at: &usize| {
                    (all[*at].lowest as usize) < range.end && all[*at].end as usize > range.start
                };
                for at in windows.clone().filter(meets) {
                    let of_window = window(at, mesh.face_count());
                    let terms = &terms[of_window.clone()];
                    let triangles = triangles(mesh, identity, of_window, &mut worker.triangles);
                    let first = range.start as u32;
                    width.run(Collect {
                        triangles,
                        terms,
                        first,
                        block: &mut worker.block,
                        vertices: &mut *vertices,
                        marks: &mut *marks,
                    });
                }
            },
        );
    }

    /// Finishes vertices that no later triangle uses.
    fn finish(&mut self, range: Range<usize>, width: Width) {
        let ranges = split(range, self.workers.len(), 1);
        let vertices = parts(&mut self.vertices, 0, ranges.clone());
        let jobs = vertices.zip(ranges.map(|range| &self.marks[range]));
        workers::run(&mut self.workers, jobs, |worker, (vertices, marks)| {
            width.run(Finish { vertices, marks, all_used: &mut worker.all_used });
        });
    }

    /// Writes the corners of windows whose vertices are finished.
    fn write(&mut self, mesh: &Mesh<'_>, windows: Range<usize>, width: Width, out: &mut [[f32; 4]]) {
        let (identity, vertices) = (self.weld.identity(), &self.vertices[..]);
        let ranges = split(triangles_of(windows, mesh), self.workers.len(), WINDOW);
        let out = parts(out.as_chunks_mut::<3>().0, 0, ranges.clone());
        workers::run(&mut self.workers, ranges.zip(out), |worker, (range, out)| {
            for (first, out) in range.step_by(WINDOW).zip(out.chunks_mut(WINDOW)) {
                let triangles = triangles(mesh, identity, first..first + out.len(), &mut worker.triangles);
                width.run(Write { triangles, first, vertices, out, special: &mut worker.special });
            }
        });
        self.workers.iter_mut().for_each(|worker| self.special.take(&mut worker.special));
    }

    /// Whether the order of the reference's last edges could show. `tail` is of all vertices, used or not.
    fn last_run_could_show(&self, mesh: &Mesh<'_>, tail: TailCells) -> bool {
        let (identity, vertices) = (self.weld.identity(), &self.vertices[..]);
        if self.workers.iter().all(|worker| worker.all_used) {
            let run = LastRun { mesh, identity, vertices, bounds: &self.weld.bounds };
            return run.could_show(tail, &self.special.in_tail);
        }
        let mut used = vertices.iter().filter(|vertex| vertex.is_used()).map(Vertex::position);
        let bounds = Bounds::of(used.next().unwrap_or_default(), used);
        let run = LastRun { mesh, identity, vertices, bounds: &bounds };
        let tail = TailCells::first(mesh, identity, &bounds, self.is_shuffled());
        let points = run.points(&tail);
        run.could_show(tail, &points)
    }

    /// The welded vertex at each corner of some triangles, named by the first corner of these, and whether it is undecided.
    pub fn names(&mut self, mesh: &Mesh<'_>, list: &[u32]) -> (Vec<u32>, Vec<bool>) {
        let identity = self.weld.identity();
        let of = |&at: &u32| triangles(mesh, identity, at as usize..at as usize + 1, &mut Vec::new())[0];
        let of_corner: Vec<u32> = list.iter().flat_map(of).collect();
        for &vertex in &of_corner {
            self.vertices[vertex as usize].print[0] = u32::MAX;
        }
        let mut name = |(corner, &vertex): (u32, &u32)| {
            let vertex = &mut self.vertices[vertex as usize];
            vertex.print[0] = vertex.print[0].min(corner);
            (vertex.print[0], vertex.sum[3] == UNDECIDED)
        };
        (0..).zip(&of_corner).map(&mut name).unzip()
    }
}

/// The triangles of windows.
fn triangles_of(windows: Range<usize>, mesh: &Mesh<'_>) -> Range<usize> {
    windows.start * WINDOW..(windows.end * WINDOW).min(mesh.face_count())
}

/// A range cut into windows.
fn windows_of(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count.div_ceil(WINDOW)).map(move |at| window(at, count))
}

fn window(at: usize, count: usize) -> Range<usize> {
    at * WINDOW..((at + 1) * WINDOW).min(count)
}

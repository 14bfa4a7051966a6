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

use std::ops::Range;

use crate::weld::Bounds;
use crate::{Faces, Mesh};

use super::Mode;
use block::Block;
use last_run::{LastRun, TailCells};
use source::{RowBuffer, Rows, triangles};
use steps::{Add, Extent, Finish, Read, Special, Write};
pub(super) use vertices::UNDECIDED;
use vertices::Vertex;
use weld::{Refused, Weld};
pub(crate) use width::Width;
pub use width::WidthLimit;

/// Triangles per window: vertices are read when the first window that uses them begins, and finished when the last has ended.
const WINDOW: usize = if cfg!(small_limits) { 2 } else { 1024 };

/// The memory of a run, kept from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Fans {
    vertices: Vec<Vertex>,
    /// What the corners of each vertex say of it.
    marks: Vec<u32>,
    weld: Weld,
    windows: Vec<Window>,
    block: Box<Block>,
    rows: RowBuffer,
    triangles: Vec<[u32; 3]>,
    pub special: Special,
    /// Triangles use every vertex.
    all_used: bool,
}

/// A window's lowest vertex of it and all later windows, its own last, and that of it and all earlier ones (ends of ranges).
#[derive(Clone, Copy, Debug, Default)]
struct Window {
    lowest_from_here: u32,
    end: u32,
    end_up_to_here: u32,
}

impl Fans {
    /// Writes the tangents of all triangles, and lists those with undecided vertices. False where this path does not apply:
    /// faces that are not triangles, values whose weld only the reference's order decides, last edges whose order could show.
    pub fn run(&mut self, mesh: &Mesh<'_>, mode: Mode, width: Width, out: &mut [[f32; 4]]) -> bool {
        if !matches!(mesh.faces(), Faces::Triangles) {
            return false;
        }
        if let Err(Refused) = self.weld.weld(mesh, width, &mut self.rows, &mut self.vertices) {
            return false;
        }
        self.special.clear();
        self.all_used = true;
        self.find_windows(mesh, width);
        let tail = TailCells::first(mesh, self.weld.identity(), &self.weld.bounds, self.is_shuffled());
        self.stream(mesh, &tail, width, out);
        mode == Mode::Corrected || !self.last_run_could_show(mesh, tail)
    }

    /// Finds which vertices each window uses.
    fn find_windows(&mut self, mesh: &Mesh<'_>, width: Width) {
        self.windows.clear();
        let mut end_up_to_here = 0;
        for range in windows_of(mesh.face_count()) {
            let triangles = triangles(mesh, self.weld.identity(), range, &mut self.triangles);
            let (mut lowest, mut highest) = (u32::MAX, 0);
            width.run(Extent { triangles, lowest: &mut lowest, highest: &mut highest });
            end_up_to_here = end_up_to_here.max(highest + 1);
            self.windows.push(Window { lowest_from_here: lowest, end: highest + 1, end_up_to_here });
        }
        let mut lowest = u32::MAX;
        for window in self.windows.iter_mut().rev() {
            lowest = lowest.min(window.lowest_from_here);
            window.lowest_from_here = lowest;
        }
    }

    /// Whether triangles that share vertices are far from each other in the list.
    fn is_shuffled(&self) -> bool {
        self.windows
            .last()
            .is_some_and(|last| (last.end - last.lowest_from_here) as usize > self.weld.count / 4)
    }

    /// Goes through the windows: reads what each needs first, adds it up, finishes what none needs any more, writes it.
    fn stream(&mut self, mesh: &Mesh<'_>, tail: &TailCells, width: Width, out: &mut [[f32; 4]]) {
        self.marks.resize(self.weld.count, 0);
        let (mut read, mut finished, mut written) = (0, 0, 0);
        if !self.weld.is_per_vertex() {
            self.mark_vertices(tail);
            read = self.weld.count;
        }
        for (at, range) in windows_of(mesh.face_count()).enumerate() {
            let end = (self.windows[at].end_up_to_here as usize).max(read);
            self.read(mesh, tail, read..end, width);
            read = end;
            self.add(mesh, range, width);
            let unfinished = self.windows.get(at + 1).map_or(read, |next| next.lowest_from_here as usize);
            let end = unfinished.min(read).max(finished);
            self.finish(finished..end, width);
            finished = end;
            while written <= at && self.windows[written].end as usize <= finished {
                self.write(mesh, window(written, mesh.face_count()), width, out);
                written += 1;
            }
        }
    }

    fn mark_vertices(&mut self, tail: &TailCells) {
        for (marks, vertex) in self.marks.iter_mut().zip(&self.vertices) {
            *marks = tail.mark(&vertex.record);
        }
    }

    fn read(&mut self, mesh: &Mesh<'_>, tail: &TailCells, range: Range<usize>, width: Width) {
        for part in windows_of(range.len()).map(|part| range.start + part.start..range.start + part.end) {
            let (vertices, marks) = (&mut self.vertices[part.clone()], &mut self.marks[part.clone()]);
            width.run(Read { rows: Rows::new(mesh, part, &mut self.rows), tail, vertices, marks });
        }
    }

    fn add(&mut self, mesh: &Mesh<'_>, range: Range<usize>, width: Width) {
        let triangles = triangles(mesh, self.weld.identity(), range, &mut self.triangles);
        let (block, vertices, marks) = (&mut self.block, &mut self.vertices, &mut self.marks);
        width.run(Add { triangles, block, vertices, marks });
    }

    fn finish(&mut self, range: Range<usize>, width: Width) {
        let (vertices, marks) = (&mut self.vertices[range.clone()], &self.marks[range]);
        width.run(Finish { vertices, marks, all_used: &mut self.all_used });
    }

    fn write(&mut self, mesh: &Mesh<'_>, range: Range<usize>, width: Width, out: &mut [[f32; 4]]) {
        let first = range.start;
        let out = &mut out[3 * first..3 * range.end];
        let triangles = triangles(mesh, self.weld.identity(), range, &mut self.triangles);
        width.run(Write { triangles, first, vertices: &self.vertices, out, special: &mut self.special });
    }

    /// Whether the order of the reference's last edges could show. `tail` is of all vertices, used or not.
    fn last_run_could_show(&self, mesh: &Mesh<'_>, tail: TailCells) -> bool {
        let (identity, vertices) = (self.weld.identity(), &self.vertices[..]);
        if self.all_used {
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

/// A range cut into windows.
fn windows_of(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count.div_ceil(WINDOW)).map(move |at| window(at, count))
}

fn window(at: usize, count: usize) -> Range<usize> {
    at * WINDOW..((at + 1) * WINDOW).min(count)
}

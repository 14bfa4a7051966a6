//! Whole fans: the tangents of vertices around which all triangles certainly share one.
//!
//! MikkTSpace groups the triangles around a vertex by shared edges and UV orientation, splits groups by angle, and sums each
//! part in triangle order. Around nearly every vertex there is one part. So every triangle adds its weighted tangents
//! straight to its vertices, in order, with some marks and a fingerprint of its edges there, and a vertex is decided when these
//! prove that its triangles are one part. No edge is looked up. What is not decided is left to the general path.

mod block;
mod last_run;
mod source;
mod vertices;
mod weld;
mod width;

use std::ops::Range;

use crate::{Faces, Mesh};

use super::Mode;
use block::{BLOCK, Block};
use last_run::{LastRun, bounds};
use source::{for_each_record, read_triangles};
pub(super) use vertices::UNDECIDED;
use vertices::Vertex;
use weld::{Refused, Weld};
use width::Task;
pub(crate) use width::Width;
pub use width::WidthLimit;

/// Triangles per window: vertices are read when the first window that uses them begins, and finished when the last has ended.
const WINDOW: usize = if cfg!(small_limits) { 2 } else { 1024 };

/// The memory of a run, kept from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Fans {
    vertices: Vec<Vertex>,
    weld: Weld,
    windows: Vec<Window>,
    triangles: Vec<[u32; 3]>,
    block: Box<Block>,
    /// The triangles with an undecided vertex, ascending.
    pub undecided: Vec<u32>,
}

/// A window's lowest vertex, that of all windows from it on, and the end of all vertices up to it.
#[derive(Clone, Copy, Debug, Default)]
struct Window {
    lowest: u32,
    lowest_from_here: u32,
    end: u32,
    end_up_to_here: u32,
}

impl Fans {
    /// Writes the tangents of all triangles, and lists those with undecided vertices. False where this path does not apply:
    /// faces that are not triangles, values whose weld only the reference's order decides.
    pub fn run(&mut self, mesh: &Mesh<'_>, mode: Mode, width: Width, out: &mut [[f32; 4]]) -> bool {
        if !matches!(mesh.faces(), Faces::Triangles) {
            return false;
        }
        if let Err(Refused) = self.weld.weld(mesh, &mut self.vertices) {
            return false;
        }
        self.undecided.clear();
        self.triangles.resize(WINDOW.min(mesh.face_count()), [0; 3]);
        self.find_windows(mesh);
        self.stream(mesh, width, out);
        mode == Mode::Corrected || !self.last_run_could_show(mesh)
    }

    fn last_run_could_show(&self, mesh: &Mesh<'_>) -> bool {
        let (identity, vertices) = (self.weld.identity(), &self.vertices[..]);
        LastRun { mesh, identity, vertices, bounds: bounds(mesh, identity, vertices) }.could_show()
    }

    /// Finds which vertices each window uses.
    fn find_windows(&mut self, mesh: &Mesh<'_>) {
        self.windows.clear();
        let (identity, mut end_up_to_here) = (self.weld.identity(), 0);
        for range in windows(mesh) {
            let triangles = &mut self.triangles[..range.len()];
            read_triangles(mesh, identity, range.start, triangles);
            let corners = triangles.as_flattened();
            let (lowest, highest) = corners
                .iter()
                .fold((u32::MAX, 0), |(low, high), &vertex| (low.min(vertex), high.max(vertex)));
            let end = highest + 1;
            end_up_to_here = end.max(end_up_to_here);
            self.windows.push(Window { lowest, lowest_from_here: lowest, end, end_up_to_here });
        }
        let mut lowest = u32::MAX;
        for window in self.windows.iter_mut().rev() {
            lowest = lowest.min(window.lowest);
            window.lowest_from_here = lowest;
        }
    }

    /// Goes through the windows: reads what each needs first, adds it up, finishes what none needs any more, writes it.
    fn stream(&mut self, mesh: &Mesh<'_>, width: Width, out: &mut [[f32; 4]]) {
        let identity = self.weld.identity();
        let (mut read, mut finished, mut written) = (0, 0, 0);
        for (at, range) in windows(mesh).enumerate() {
            let window = self.windows[at];
            if !self.weld.is_per_vertex() {
                read = self.vertices.len();
            }
            let end = (window.end_up_to_here as usize).max(read);
            read_vertices(mesh, read..end, &mut self.vertices);
            read = end;
            let triangles = &mut self.triangles[..range.len()];
            read_triangles(mesh, identity, range.start, triangles);
            width.run(Add { triangles, block: &mut self.block, vertices: &mut self.vertices });
            let complete = match self.windows.get(at + 1) {
                Some(next) => (next.lowest_from_here as usize).min(read),
                None => read,
            };
            if complete > finished {
                width.run(Finish { vertices: &mut self.vertices[finished..complete] });
                finished = complete;
            }
            while written <= at && self.windows[written].end as usize <= finished {
                let range = window_range(mesh, written);
                read_triangles(mesh, identity, range.start, &mut self.triangles[..range.len()]);
                width.run(Write {
                    triangles: &self.triangles[..range.len()],
                    first: range.start,
                    vertices: &self.vertices,
                    out: &mut out[3 * range.start..3 * range.end],
                    undecided: &mut self.undecided,
                });
                written += 1;
            }
        }
    }

    /// The welded vertex at each corner of some triangles, named by the first corner of these, and whether it is undecided.
    pub fn names(&mut self, mesh: &Mesh<'_>, triangles: &[u32]) -> (Vec<u32>, Vec<bool>) {
        let identity = self.weld.identity();
        let mut of_corner = vec![[0; 3]; triangles.len()];
        for (&triangle, out) in triangles.iter().zip(&mut of_corner) {
            read_triangles(mesh, identity, triangle as usize, std::slice::from_mut(out));
        }
        let of_corner = of_corner.as_flattened();
        for &vertex in of_corner {
            self.vertices[vertex as usize].print[0] = u32::MAX;
        }
        let mut name = |(corner, &vertex): (u32, &u32)| {
            let vertex = &mut self.vertices[vertex as usize];
            vertex.print[0] = vertex.print[0].min(corner);
            (vertex.print[0], vertex.sum[3] == UNDECIDED)
        };
        (0..).zip(of_corner).map(&mut name).unzip()
    }
}

fn windows(mesh: &Mesh<'_>) -> impl Iterator<Item = Range<usize>> {
    (0..mesh.face_count().div_ceil(WINDOW)).map(|at| window_range(mesh, at))
}

/// The triangles of a window.
fn window_range(mesh: &Mesh<'_>, at: usize) -> Range<usize> {
    at * WINDOW..((at + 1) * WINDOW).min(mesh.face_count())
}

fn read_vertices(mesh: &Mesh<'_>, range: Range<usize>, vertices: &mut [Vertex]) {
    for_each_record(mesh, range, |vertex, record| vertices[vertex] = Vertex::at(record));
}

/// Adds triangles to their vertices.
struct Add<'a> {
    triangles: &'a [[u32; 3]],
    block: &'a mut Block,
    vertices: &'a mut [Vertex],
}

impl Task for Add<'_> {
    #[inline(always)]
    fn run(self) {
        for triangles in self.triangles.chunks(BLOCK) {
            self.block.set(triangles);
            vertices::gather(self.block, triangles.len(), self.vertices);
            self.block.evaluate();
            vertices::scatter(self.block, triangles.len(), self.vertices);
        }
    }
}

/// Finishes vertices.
struct Finish<'a> {
    vertices: &'a mut [Vertex],
}

impl Task for Finish<'_> {
    #[inline(always)]
    fn run(self) {
        for vertex in self.vertices {
            vertex.finish();
        }
    }
}

/// Copies tangents from vertices to corners, and lists triangles with undecided vertices.
struct Write<'a> {
    triangles: &'a [[u32; 3]],
    first: usize,
    vertices: &'a [Vertex],
    out: &'a mut [[f32; 4]],
    undecided: &'a mut Vec<u32>,
}

impl Task for Write<'_> {
    #[inline(always)]
    fn run(self) {
        let out = self.out.as_chunks_mut::<3>().0;
        for ((at, triangle), out) in (self.first as u32..).zip(self.triangles).zip(out) {
            *out = triangle.map(|vertex| self.vertices[vertex as usize].sum);
            if (out[0][3] == UNDECIDED) | (out[1][3] == UNDECIDED) | (out[2][3] == UNDECIDED) {
                self.undecided.push(at);
            }
        }
    }
}

//! The steps of a window, each compiled for every vector width.

use super::block::{BLOCK, Block, marks};
use super::last_run::TailCells;
use super::source::Rows;
use super::vertices::{IN_TAIL, UNDECIDED, Vertex, gather, scatter};
use super::width::Task;

/// Makes vertices of rows.
pub(super) struct Read<'a> {
    pub rows: Rows<'a>,
    pub tail: &'a TailCells,
    pub vertices: &'a mut [Vertex],
    pub marks: &'a mut [u32],
}

impl Task for Read<'_> {
    #[inline(always)]
    fn run(self) {
        for ((record, vertex), marks) in self.rows.records().zip(self.vertices).zip(self.marks) {
            *vertex = Vertex::at(record);
            *marks = self.tail.mark(&record);
        }
    }
}

/// Adds triangles to their vertices.
pub(super) struct Add<'a> {
    pub triangles: &'a [[u32; 3]],
    pub block: &'a mut Block,
    pub vertices: &'a mut [Vertex],
    pub marks: &'a mut [u32],
}

impl Task for Add<'_> {
    #[inline(always)]
    fn run(self) {
        for triangles in self.triangles.chunks(BLOCK) {
            self.block.set(triangles);
            gather(self.block, triangles.len(), self.vertices);
            self.block.evaluate();
            scatter(self.block, triangles.len(), self.vertices, self.marks);
        }
    }
}

/// Finishes vertices, and notes whether triangles use all of them.
pub(super) struct Finish<'a> {
    pub vertices: &'a mut [Vertex],
    pub marks: &'a [u32],
    pub all_used: &'a mut bool,
}

impl Task for Finish<'_> {
    #[inline(always)]
    fn run(self) {
        for (vertex, &marks) in self.vertices.iter_mut().zip(self.marks) {
            *self.all_used &= vertex.finish(marks);
        }
    }
}

/// Copies tangents from vertices to corners.
pub(super) struct Write<'a> {
    pub triangles: &'a [[u32; 3]],
    /// The number of the first triangle.
    pub first: usize,
    pub vertices: &'a [Vertex],
    pub out: &'a mut [[f32; 4]],
    pub special: &'a mut Special,
}

/// Triangles and corners that need another look, ascending.
#[derive(Debug, Default)]
pub(crate) struct Special {
    /// Triangles with an undecided vertex.
    pub undecided: Vec<u32>,
    /// Corners of vertices in the tail's cells.
    pub in_tail: Vec<u32>,
}

impl Task for Write<'_> {
    #[inline(always)]
    fn run(self) {
        let out = self.out.as_chunks_mut::<3>().0;
        for ((at, triangle), out) in (self.first as u32..).zip(self.triangles).zip(out) {
            // Each corner by itself: an array of all three would take a detour over the stack.
            let mut is_special = false;
            for k in 0..3 {
                let tangent = self.vertices[triangle[k] as usize].sum;
                is_special |= tangent[3].abs() != 1.0;
                out[k] = tangent;
            }
            if is_special {
                self.special.note(at, out);
            }
        }
    }
}

impl Special {
    pub fn clear(&mut self) {
        self.undecided.clear();
        self.in_tail.clear();
    }

    /// Lists a triangle with undecided vertices, and its corners in the tail's cells, which get their signs back.
    #[cold]
    fn note(&mut self, triangle: u32, out: &mut [[f32; 4]; 3]) {
        for (corner, [_, _, _, sign]) in (3 * triangle..).zip(&mut *out) {
            let is_minus_zero = *sign == 0.0 && sign.is_sign_negative();
            if sign.abs() == IN_TAIL.abs() || is_minus_zero {
                *sign /= IN_TAIL;
                self.in_tail.push(corner);
            }
        }
        if out.iter().any(|tangent| tangent[3] == UNDECIDED) {
            self.undecided.push(triangle);
        }
    }
}

/// Finds the lowest and the highest vertex of triangles.
pub(super) struct Extent<'a> {
    pub triangles: &'a [[u32; 3]],
    pub lowest: &'a mut u32,
    pub highest: &'a mut u32,
}

impl Task for Extent<'_> {
    #[inline(always)]
    fn run(self) {
        for &vertex in self.triangles.as_flattened() {
            *self.lowest = vertex.min(*self.lowest);
            *self.highest = vertex.max(*self.highest);
        }
    }
}

impl TailCells {
    /// The marks that a vertex begins with.
    #[inline(always)]
    pub fn mark(&self, record: &[f32; 8]) -> u32 {
        if self.hold(record) { marks::IN_TAIL } else { 0 }
    }
}

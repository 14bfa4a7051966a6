//! The steps of a window, each compiled for every vector width.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use crate::math::{dot, normalized_unless_zero};
use crate::topology::weld::Point;
use crate::util::radix_sort::{sort, sort_by_key};

use crate::exec::simd::Task;
use crate::tangents::fast::accumulator::{IN_TAIL, UNDECIDED, Unused, Vertex, gather, scatter, scatter_sums};
use crate::tangents::fast::edge_tail::TailCells;
use crate::tangents::fast::input::Source;
use crate::tangents::fast::kernel::{BLOCK, Block, Fourth, marks, turns};
use crate::tangents::fast::rows::{Rows, Welded};

/// Makes vertices of rows.
pub(crate) struct Read<'a> {
    pub rows: Welded<'a>,
    pub tail: &'a TailCells,
    pub vertices: &'a mut [Vertex],
    pub marks: &'a mut [u32],
}

impl Task for Read<'_> {
    #[inline(always)]
    fn run(self) {
        match self.rows {
            Welded::Records(records) => {
                for ((record, vertex), marks) in records.iter().zip(self.vertices).zip(self.marks) {
                    vertex.record = *record;
                    vertex.clear();
                    *marks = self.tail.mark([record[0], record[1], record[2]]);
                }
            }
            Welded::Rows(Rows { positions, normals, uvs }) => {
                let rows = positions.iter().zip(normals).zip(uvs);
                for ((((position, normal), uv), vertex), marks) in rows.zip(self.vertices).zip(self.marks) {
                    // Piece by piece: a record on the stack would be written in pieces and read as a whole, which waits.
                    vertex.record[..3].copy_from_slice(position);
                    vertex.record[3..6].copy_from_slice(normal);
                    vertex.record[6..].copy_from_slice(uv);
                    vertex.clear();
                    *marks = self.tail.mark(*position);
                }
            }
        }
    }
}

/// Adds triangles to their vertices.
pub(crate) struct Add<'a> {
    pub triangles: &'a [[u32; 3]],
    /// The number of the first of `vertices`.
    pub first: u32,
    pub block: &'a mut Block,
    pub vertices: &'a mut [Vertex],
    pub marks: &'a mut [u32],
}

impl Task for Add<'_> {
    #[inline(always)]
    fn run(self) {
        for triangles in self.triangles.chunks(BLOCK) {
            self.block.set(triangles, self.first);
            gather(self.block, triangles.len(), self.vertices);
            self.block.evaluate(Fourth::Turns);
            scatter(self.block, triangles.len(), 0, self.vertices, self.marks);
        }
    }
}

/// Adds triangles to their vertices, the sums alone.
pub(crate) struct AddTerms<'a> {
    pub triangles: &'a [[u32; 3]],
    /// The number of the first of `vertices`.
    pub first: u32,
    pub block: &'a mut Block,
    pub vertices: &'a mut [Vertex],
}

impl Task for AddTerms<'_> {
    #[inline(always)]
    fn run(self) {
        for triangles in self.triangles.chunks(BLOCK) {
            self.block.set(triangles, self.first);
            gather(self.block, triangles.len(), self.vertices);
            self.block.evaluate_terms();
            scatter_sums(self.block, triangles.len(), self.vertices);
        }
    }
}

/// Writes what each corner adds to its vertex, and with `MARKS` its marks as bits.
pub(crate) struct Evaluate<'a, const MARKS: bool> {
    pub triangles: &'a [[u32; 3]],
    pub block: &'a mut Block,
    pub vertices: &'a [Vertex],
    pub out: &'a mut [[[f32; 4]; 3]],
}

impl<const MARKS: bool> Task for Evaluate<'_, MARKS> {
    #[inline(always)]
    fn run(self) {
        for (triangles, out) in self.triangles.chunks(BLOCK).zip(self.out.chunks_mut(BLOCK)) {
            self.block.set(triangles, 0);
            gather(self.block, triangles.len(), self.vertices);
            if MARKS {
                self.block.evaluate(Fourth::Marks);
            } else {
                self.block.evaluate_terms();
            }
            for k in 0..3 {
                for (out, term) in out.iter_mut().zip(&self.block.sum[k]) {
                    out[k] = *term;
                }
            }
        }
    }
}

/// Adds what [`Evaluate`] wrote to those vertices that are in `vertices`.
pub(crate) struct Collect<'a> {
    pub triangles: &'a [[u32; 3]],
    pub terms: &'a [[[f32; 4]; 3]],
    /// The number of the first vertex.
    pub first: u32,
    pub block: &'a mut Block,
    pub vertices: &'a mut [Vertex],
    pub marks: &'a mut [u32],
}

impl Task for Collect<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { triangles, terms, first, block, vertices, marks } = self;
        for (triangles, terms) in triangles.chunks(BLOCK).zip(terms.chunks(BLOCK)) {
            block.set(triangles, 0);
            block.prints();
            for (i, terms) in terms.iter().enumerate() {
                for k in 0..3 {
                    let [x, y, z, marks] = terms[k];
                    block.marks[k][i] = marks.to_bits();
                    block.sum[k][i] = [x, y, z, turns(marks.to_bits())];
                }
            }
            scatter(block, triangles.len(), first, vertices, marks);
        }
    }
}

/// As [`Collect`], of terms without marks.
pub(crate) struct CollectTerms<'a> {
    pub triangles: &'a [[u32; 3]],
    pub terms: &'a [[[f32; 4]; 3]],
    /// The number of the first vertex.
    pub first: u32,
    pub vertices: &'a mut [Vertex],
}

impl Task for CollectTerms<'_> {
    #[inline(always)]
    fn run(self) {
        for (triangle, terms) in self.triangles.iter().zip(self.terms) {
            for k in 0..3 {
                let at = triangle[k].wrapping_sub(self.first) as usize;
                let Some(vertex) = self.vertices.get_mut(at) else { continue };
                for lane in 0..4 {
                    vertex.sum[lane] += terms[k][lane];
                }
            }
        }
    }
}

/// Finishes vertices, and notes those that no triangle uses.
pub(crate) struct Finish<'a> {
    pub vertices: &'a mut [Vertex],
    pub marks: &'a [u32],
    pub unused: &'a mut Unused,
}

impl Task for Finish<'_> {
    #[inline(always)]
    fn run(self) {
        let mut lanes = Lanes::default();
        for (vertices, marks) in self.vertices.chunks_mut(BLOCK).zip(self.marks.chunks(BLOCK)) {
            lanes.load(vertices);
            lanes.normalize();
            for (i, (vertex, &marks)) in vertices.iter_mut().zip(marks).enumerate() {
                let sign = vertex.sign(marks, lanes.is_usable[i] != 0);
                if sign.is_nan() {
                    self.unused.note(vertex.position());
                }
                vertex.sum = [lanes.sum[0][i], lanes.sum[1][i], lanes.sum[2][i], sign];
            }
        }
    }
}

/// Finishes vertices whose signs are known, and notes whether those that are decided have usable tangents.
pub(crate) struct FinishPlanned<'a> {
    pub vertices: &'a mut [Vertex],
    pub signs: &'a [f32],
    pub all_usable: &'a mut bool,
}

impl Task for FinishPlanned<'_> {
    #[inline(always)]
    fn run(self) {
        let mut lanes = Lanes::default();
        let mut all_usable = true;
        for (vertices, signs) in self.vertices.chunks_mut(BLOCK).zip(self.signs.chunks(BLOCK)) {
            lanes.load(vertices);
            lanes.normalize();
            for (i, (vertex, &sign)) in vertices.iter_mut().zip(signs).enumerate() {
                all_usable &= (lanes.is_usable[i] != 0) | (sign == UNDECIDED);
                vertex.sum = [lanes.sum[0][i], lanes.sum[1][i], lanes.sum[2][i], sign];
            }
        }
        *self.all_usable &= all_usable;
    }
}

/// Sums and normals of a block of vertices, one component after the other.
struct Lanes {
    sum: [[f32; BLOCK]; 3],
    normal: [[f32; BLOCK]; 3],
    is_usable: [u32; BLOCK],
}

impl Default for Lanes {
    fn default() -> Self {
        Self { sum: [[0.0; BLOCK]; 3], normal: [[0.0; BLOCK]; 3], is_usable: [0; BLOCK] }
    }
}

impl Lanes {
    #[inline(always)]
    fn load(&mut self, vertices: &[Vertex]) {
        for (i, vertex) in vertices.iter().take(BLOCK).enumerate() {
            for axis in 0..3 {
                self.sum[axis][i] = vertex.sum[axis];
                self.normal[axis][i] = vertex.record[3 + axis];
            }
        }
    }

    /// Sums to tangents; usable in the sense of a repair, with a margin for rounding.
    #[inline(always)]
    fn normalize(&mut self) {
        for i in 0..BLOCK {
            let tangent = normalized_unless_zero([self.sum[0][i], self.sum[1][i], self.sum[2][i]]);
            let normal = [self.normal[0][i], self.normal[1][i], self.normal[2][i]];
            let (along, squared) = (dot(tangent, normal), dot(normal, normal));
            let error = (dot(tangent, tangent) - 1.0).abs();
            let is_usable =
                (error < 1e-3) & (squared > 1e-30) & (squared < 1e30) & (along * along < 0.99 * squared);
            for axis in 0..3 {
                self.sum[axis][i] = tangent[axis];
            }
            self.is_usable[i] = if is_usable { 1 } else { 0 };
        }
    }
}

/// Copies tangents from vertices to corners: those of faces of `N` corners, or one after the other.
pub(crate) struct Write<'a, const N: usize> {
    pub faces: &'a [[u32; N]],
    /// The number of the first face.
    pub first: usize,
    pub vertices: &'a [Vertex],
    /// The number of the first of `vertices`.
    pub first_vertex: u32,
    pub out: &'a mut [[[f32; 4]; N]],
    pub special: &'a mut Special,
}

/// Faces and corners that need another look, ascending.
#[derive(Debug, Default)]
pub(crate) struct Special {
    /// Faces with an undecided vertex, as they were written; in the end their first triangles.
    pub undecided: Vec<u32>,
    /// Corners of vertices in the tail's cells; in the end entries.
    pub in_tail: Vec<Point>,
    /// For sorting these.
    room: Vec<Point>,
}

impl<const N: usize> Task for Write<'_, N> {
    #[inline(always)]
    fn run(self) {
        let out = &mut self.out[..self.faces.len()];
        for i in 0..self.faces.len() {
            let mut specials = 0;
            for k in 0..N {
                let at = self.faces[i][k].wrapping_sub(self.first_vertex) as usize;
                let vertex = &self.vertices[at];
                out[i][k] = vertex.sum;
                specials |= (vertex.sum[3].to_bits() << 1) ^ (1f32.to_bits() << 1);
            }
            if specials != 0 {
                let at = |vertex: u32| vertex.wrapping_sub(self.first_vertex) as usize;
                let positions = self.faces[i].map(|vertex| self.vertices[at(vertex)].position());
                self.special.note((self.first + i) as u32, positions, &mut out[i]);
            }
        }
    }
}

impl Special {
    pub fn clear(&mut self) {
        self.undecided.clear();
        self.in_tail.clear();
    }

    /// Puts everything in ascending order, and makes triangles and entries of corners, which cut faces were written as.
    pub fn settle(&mut self, source: &Source<'_>) {
        sort(&mut self.undecided);
        sort_by_key(&mut self.in_tail, |point| point.entry.into(), &mut self.room);
        if source.is_cut() {
            let mut end = 0;
            self.undecided.retain_mut(|corner| {
                let is_new = *corner >= end;
                if is_new {
                    *corner = source.triangles_at(*corner).start;
                    end = source.corners_of_face(*corner).end;
                }
                is_new
            });
            for at in 0..self.in_tail.len() {
                let Point { position, entry: corner } = self.in_tail[at];
                let mut points = source.entries(corner).map(|entry| Point { position, entry });
                self.in_tail[at] = points.next().expect("a triangle has the corner");
                self.in_tail.extend(points);
            }
            sort_by_key(&mut self.in_tail, |point| point.entry.into(), &mut self.room);
        }
    }

    /// Appends what another has, which is empty afterwards.
    pub fn take(&mut self, other: &mut Self) {
        self.undecided.append(&mut other.undecided);
        self.in_tail.append(&mut other.in_tail);
    }

    /// Leaves entries undecided, all of their vertices'.
    #[cold]
    pub fn leave(&mut self, source: &Source<'_>, entries: impl Iterator<Item = u32>, out: &mut [[f32; 4]]) {
        for entry in entries {
            out[source.corner(entry) as usize][3] = UNDECIDED;
            let face = source.face_of(entry / 3).start;
            if self.undecided.last() != Some(&face) {
                self.undecided.push(face);
            }
        }
        sort(&mut self.undecided);
        self.undecided.dedup();
    }

    /// Lists a face with undecided vertices, and its corners in the tail's cells, which get their signs back.
    #[cold]
    pub fn note<const N: usize>(&mut self, face: u32, positions: [[f32; 3]; N], out: &mut [[f32; 4]; N]) {
        for ((entry, position), [_, _, _, sign]) in (N as u32 * face..).zip(positions).zip(&mut *out) {
            let is_minus_zero = *sign == 0.0 && sign.is_sign_negative();
            if sign.abs() == IN_TAIL.abs() || is_minus_zero {
                *sign /= IN_TAIL;
                self.in_tail.push(Point { position, entry });
            }
        }
        if out.iter().any(|tangent| tangent[3] == UNDECIDED) {
            self.undecided.push(face);
        }
    }
}

/// Finds the lowest and the highest of vertices.
pub(crate) struct Extent<'a> {
    pub vertices: &'a [u32],
    pub lowest: &'a mut u32,
    /// One more than the highest.
    pub end: &'a mut u32,
}

impl Task for Extent<'_> {
    #[inline(always)]
    fn run(self) {
        let (mut lowest, mut highest) = (u32::MAX, 0);
        for &vertex in self.vertices {
            lowest = vertex.min(lowest);
            highest = vertex.max(highest);
        }
        (*self.lowest, *self.end) = (lowest, highest + 1);
    }
}

impl TailCells {
    /// The marks that a vertex begins with.
    #[inline(always)]
    pub fn mark(&self, position: [f32; 3]) -> u32 {
        if self.hold(position) { marks::IN_TAIL } else { 0 }
    }
}

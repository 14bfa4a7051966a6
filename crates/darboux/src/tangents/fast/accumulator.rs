//! One cache line per welded vertex: its values, and the sums of what its corners add.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use std::ops::Range;

use crate::tangents::fast::kernel::{BLOCK_SIZE, TriangleBlock};
use crate::tangents::fast::proof::UNDECIDED;
use crate::tangents::fast::vertex_record::{VertexRecord, position_of};

/// A welded vertex. Its marks lie in an array of their own, beside it.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(crate) struct VertexAccumulator {
    pub record: VertexRecord,
    /// The sum of the weighted tangents, and the number of wedges that hold the ray +u. In a finished
    /// vertex: the tangent and the sign.
    pub sum: [f32; 4],
    /// The sum of the corners' fingerprints. In a finished vertex: [`flags`] in the first lane.
    pub fingerprint: [u32; 4],
}

/// Flags of finished vertices whose corners have to be listed when they are written.
pub(crate) mod flags {
    /// The general path computes the tangent.
    pub const IS_UNDECIDED: u32 = 1;
    /// The vertex lies in one of the cells that the search for the last edges examines (see `edge_tail.rs`).
    pub const IN_TAIL: u32 = 2;
}

impl VertexAccumulator {
    /// Sets the sums to zero.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.sum = [0.0; 4];
        self.fingerprint = [0; 4];
    }

    /// Adds to the sum of weighted tangents.
    #[inline(always)]
    pub fn add_sum(&mut self, term: &[f32; 4]) {
        for lane in 0..4 {
            self.sum[lane] += term[lane];
        }
    }

    /// Adds to both sums. `fingerprint`: a reference, because a copy on the stack, written in pieces and read
    /// as a whole, stalls the processor.
    #[inline(always)]
    pub fn add(&mut self, term: [f32; 4], fingerprint: &[u32; 4]) {
        self.add_sum(&term);
        for lane in 0..4 {
            self.fingerprint[lane] = self.fingerprint[lane].wrapping_add(fingerprint[lane]);
        }
    }

    /// Replaces the sums by the result.
    #[inline(always)]
    pub fn finish(&mut self, [x, y, z]: [f32; 3], sign: f32, flags: u32) {
        self.sum = [x, y, z, sign];
        self.fingerprint[0] = flags;
    }

    /// Leaves a finished vertex to later stages.
    #[inline(always)]
    pub fn undecide(&mut self) {
        self.sum[3] = UNDECIDED;
        self.fingerprint[0] |= flags::IS_UNDECIDED;
    }

    /// The tangent and the sign of a finished vertex.
    #[inline(always)]
    pub fn tangent(&self) -> [f32; 4] {
        self.sum
    }

    /// The [`flags`] of a finished vertex.
    #[inline(always)]
    pub fn flags(&self) -> u32 {
        self.fingerprint[0]
    }

    #[inline(always)]
    pub fn normal(&self) -> [f32; 3] {
        let [_, _, _, x, y, z, ..] = self.record;
        [x, y, z]
    }

    #[inline(always)]
    pub fn position(&self) -> [f32; 3] {
        position_of(self.record)
    }
}

/// Copies the records of the vertices of a block's first `count` triangles into the block.
#[inline(always)]
pub(crate) fn gather(block: &mut TriangleBlock, count: usize, vertices: &[VertexAccumulator]) {
    for k in 0..3 {
        for i in 0..count.min(BLOCK_SIZE) {
            let [a, b, c, d, e, f, g, h] = vertices[block.vertex[k][i] as usize].record;
            block.packed[k][0][i] = [a, b, c, d];
            block.packed[k][1][i] = [e, f, g, h];
        }
    }
}

/// Consecutive vertices that one thread adds to.
pub(crate) struct VertexRange<'a> {
    /// The number of the first vertex.
    pub first: u32,
    pub vertices: &'a mut [VertexAccumulator],
    /// The marks of each vertex.
    pub marks: &'a mut [u32],
}

impl<'a> VertexRange<'a> {
    /// The vertices whose numbers are in `range`. `first`: the number of the first of `vertices`.
    pub fn new(
        range: Range<usize>,
        first: usize,
        vertices: &'a mut [VertexAccumulator],
        marks: &'a mut [u32],
    ) -> Self {
        let place = range.start - first..range.end - first;
        let (vertices, marks) = (&mut vertices[place.clone()], &mut marks[place]);
        Self { first: range.start as u32, vertices, marks }
    }
}

/// Adds a block's first `count` triangles, in order, to their vertices.
#[inline(always)]
pub(crate) fn scatter(
    block: &TriangleBlock,
    count: usize,
    vertices: &mut [VertexAccumulator],
    marks: &mut [u32],
) {
    let marks = &mut marks[..vertices.len()];
    if block.has_marks_only {
        for i in 0..count.min(BLOCK_SIZE) {
            (0..3).for_each(|k| marks[block.vertex[k][i] as usize] |= block.marks[k][i]);
        }
        return;
    }
    for i in 0..count.min(BLOCK_SIZE) {
        for k in 0..3 {
            let at = block.vertex[k][i] as usize;
            vertices[at].add(block.sum[k][i], &block.fingerprint[k][i]);
            marks[at] |= block.marks[k][i];
        }
    }
}

/// Adds the weighted tangents of a block's first `count` triangles to their vertices, in order.
#[inline(always)]
pub(crate) fn scatter_sums(block: &TriangleBlock, count: usize, vertices: &mut [VertexAccumulator]) {
    for i in 0..count.min(BLOCK_SIZE) {
        for k in 0..3 {
            vertices[block.vertex[k][i] as usize].add_sum(&block.sum[k][i]);
        }
    }
}

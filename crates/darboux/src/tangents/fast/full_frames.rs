//! Full frames: the bitangents and the derivatives' lengths that belong to the decided tangents are added up
//! with these, or in a second pass where the first was scattered.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use crate::Frame;
use crate::math::normalized_unless_zero;

use crate::exec::simd::{Task, Width};
use crate::tangents::fast::kernel::{BLOCK_SIZE, TriangleBlock};
use crate::tangents::fast::second_pass::SecondPass;
use crate::tangents::fast::triangle_list::TriangleList;
use crate::tangents::fast::vertex_quantity::VertexQuantity;
use crate::tangents::mikktspace::raw_frames::DEFAULT_FRAME;

/// What the corners of a vertex add up to, and after [`VertexQuantity::finish`] the vertex's own values.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FrameAccumulator {
    /// The bitangent, and the sum of the weights.
    bitangent: [f32; 4],
    /// The lengths of dP/du and dP/dv.
    magnitude: [f32; 2],
}

/// The bitangents and magnitudes of a mesh's vertices. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct FullFrames(Vec<FrameAccumulator>);

impl FullFrames {
    /// The quantities of vertices, which a streamed pass adds up.
    pub fn quantities(&mut self) -> &mut Vec<FrameAccumulator> {
        &mut self.0
    }

    /// Computes the bitangents and magnitudes of all vertices of a mesh.
    pub fn compute(&mut self, pass: SecondPass<'_>) {
        pass.run(&mut self.0);
    }

    /// Gives vertices the bitangent and the magnitudes of corners that nothing writes. `vertices`: those
    /// whose triangles all have no UV area.
    pub fn set_defaults(&mut self, vertices: &[u32]) {
        let Frame { bitangent: [x, y, z], magnitude, .. } = DEFAULT_FRAME;
        for &vertex in vertices {
            self.0[vertex as usize] = FrameAccumulator { bitangent: [x, y, z, 0.0], magnitude };
        }
    }

    /// Writes the bitangents and magnitudes of corners, the first of which is corner number `first`. They are
    /// unspecified at corners whose tangent is undecided.
    pub fn write(&self, list: &TriangleList<'_>, first: usize, out: &mut [Frame]) {
        let corners = first..first + out.len();
        let mut out = out.iter_mut();
        list.visit_vertices(corners, |vertex| {
            let FrameAccumulator { bitangent: [x, y, z, _], magnitude } = self.0[vertex as usize];
            if let Some(out) = out.next() {
                (out.bitangent, out.magnitude) = ([x, y, z], magnitude);
            }
        });
    }
}

impl VertexQuantity for FrameAccumulator {
    const NEEDS_ANGLES: bool = true;

    #[inline(always)]
    fn evaluate(block: &mut TriangleBlock) {
        block.bitangent_terms();
    }

    #[inline(always)]
    fn add(&mut self, block: &TriangleBlock, k: usize, i: usize) {
        (0..4).for_each(|lane| self.bitangent[lane] += block.sum[k][i][lane]);
        (0..2).for_each(|lane| self.magnitude[lane] += block.magnitude_sum[k][i][lane]);
    }

    fn finish(width: Width, vertices: &mut [Self]) {
        width.run(FinishFrames(vertices));
    }
}

/// Turns sums into unit bitangents and weighted means.
struct FinishFrames<'a>(&'a mut [FrameAccumulator]);

impl Task for FinishFrames<'_> {
    #[inline(always)]
    fn run(self) {
        let mut lanes = [[0.0; BLOCK_SIZE]; 6];
        for frames in self.0.chunks_mut(BLOCK_SIZE) {
            for (i, frame) in frames.iter().enumerate() {
                let FrameAccumulator { bitangent: [x, y, z, weight], magnitude: [s, t] } = *frame;
                [x, y, z, weight, s, t].into_iter().zip(&mut lanes).for_each(|(value, lane)| lane[i] = value);
            }
            for i in 0..BLOCK_SIZE {
                let [x, y, z] = normalized_unless_zero([lanes[0][i], lanes[1][i], lanes[2][i]]);
                let weight = if lanes[3][i] > 0.0 { lanes[3][i] } else { 1.0 };
                (lanes[0][i], lanes[1][i], lanes[2][i]) = (x, y, z);
                (lanes[4][i], lanes[5][i]) = (lanes[4][i] / weight, lanes[5][i] / weight);
            }
            for (i, frame) in frames.iter_mut().enumerate() {
                let [x, y, z, weight, s, t] = lanes.each_ref().map(|lane| lane[i]);
                *frame = FrameAccumulator { bitangent: [x, y, z, weight], magnitude: [s, t] };
            }
        }
    }
}

//! Whole frames: the bitangents and magnitudes that go with tangents, once these are decided.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use crate::Frame;
use crate::Mesh;
use crate::math::normalized_unless_zero;

use crate::exec::limits::RunLimits;
use crate::exec::simd::{Task, Width};
use crate::tangents::fast::Fans;
use crate::tangents::fast::kernel::{BLOCK, Block};
use crate::tangents::fast::second_pass::OfVertex;

/// What the corners of a vertex add up to: the bitangent and the weight; the magnitudes of both directions.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    bitangent: [f32; 4],
    magnitude: [f32; 2],
}

impl Fans {
    /// Adds up the bitangents and magnitudes of all vertices of the mesh that this has just run on.
    pub fn add_frames(&mut self, mesh: &Mesh<'_>, limits: RunLimits<'_>) {
        let mut sums = std::mem::take(&mut self.sums);
        self.add_again(mesh, limits, &mut sums);
        self.sums = sums;
    }

    /// Writes the bitangents and the magnitudes at the corners from number `first` on, as many as `out` has. Anything where the tangent is
    /// not decided.
    pub fn write_rest(&self, mesh: &Mesh<'_>, first: usize, out: &mut [Frame]) {
        let corners = first..first + out.len();
        let mut out = out.iter_mut();
        self.source(mesh).visit(corners, |vertex| {
            let Sums { bitangent: [x, y, z, _], magnitude } = self.sums[vertex as usize];
            if let Some(out) = out.next() {
                (out.bitangent, out.magnitude) = ([x, y, z], magnitude);
            }
        });
    }
}

impl OfVertex for Sums {
    #[inline(always)]
    fn evaluate(block: &mut Block) {
        block.evaluate_bitangents();
    }

    #[inline(always)]
    fn add(&mut self, block: &Block, k: usize, i: usize) {
        (0..4).for_each(|lane| self.bitangent[lane] += block.sum[k][i][lane]);
        (0..2).for_each(|lane| self.magnitude[lane] += block.magnitude_sum[k][i][lane]);
    }

    fn finish(width: Width, of_vertices: &mut [Self]) {
        width.run(FinishFrames(of_vertices));
    }
}

/// From sums to directions and means.
struct FinishFrames<'a>(&'a mut [Sums]);

impl Task for FinishFrames<'_> {
    #[inline(always)]
    fn run(self) {
        let mut lanes = [[0.0; BLOCK]; 6];
        for sums in self.0.chunks_mut(BLOCK) {
            for (i, &Sums { bitangent: [x, y, z, weight], magnitude: [s, t] }) in sums.iter().enumerate() {
                [x, y, z, weight, s, t].into_iter().zip(&mut lanes).for_each(|(value, lane)| lane[i] = value);
            }
            for i in 0..BLOCK {
                let [x, y, z] = normalized_unless_zero([lanes[0][i], lanes[1][i], lanes[2][i]]);
                let weight = if lanes[3][i] > 0.0 { lanes[3][i] } else { 1.0 };
                (lanes[0][i], lanes[1][i], lanes[2][i]) = (x, y, z);
                (lanes[4][i], lanes[5][i]) = (lanes[4][i] / weight, lanes[5][i] / weight);
            }
            for (i, sums) in sums.iter_mut().enumerate() {
                let [x, y, z, weight, s, t] = lanes.each_ref().map(|lane| lane[i]);
                *sums = Sums { bitangent: [x, y, z, weight], magnitude: [s, t] };
            }
        }
    }
}

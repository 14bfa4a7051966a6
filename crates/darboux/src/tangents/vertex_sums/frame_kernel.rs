//! The tangents of a block of vertices, lane by lane, as [`crate::tangents::vertex_sums::term_kernel`] has the terms of a block of triangles.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use std::marker::PhantomData;

use crate::math::V3;

use crate::exec::simd::{Task, Width};
use crate::tangents::vertex_sums::frame_math::{sign_of, sure_tangent};
use crate::tangents::vertex_sums::term_kernel::{TERM_BLOCK, TermLane};
use crate::tangents::vertex_sums::weighting::{SumRows, Weighting};

/// One block's arrays; reused from block to block.
pub(crate) struct FrameBlock {
    normals: [TermLane<f32>; 3],
    /// The sums of tangents and of bitangents.
    sums: [[TermLane<f32>; 3]; 2],
    /// [`Weighting::size`].
    sizes: TermLane<f32>,
    lanes: [TermLane<f32>; 4],
    /// Tangents xyz and signs w,
    pub tangents: TermLane<[f32; 4]>,
    /// and 1 where they are sure, else 0.
    pub sure: TermLane<u32>,
}

impl FrameBlock {
    pub fn new() -> Self {
        Self {
            normals: [[0.0; TERM_BLOCK]; 3],
            sums: [[[0.0; TERM_BLOCK]; 3]; 2],
            sizes: [0.0; TERM_BLOCK],
            lanes: [[0.0; TERM_BLOCK]; 4],
            tangents: [[0.0; 4]; TERM_BLOCK],
            sure: [0; TERM_BLOCK],
        }
    }

    /// Takes up to [`TERM_BLOCK`] vertices; the lanes beyond them keep what they had.
    #[inline(always)]
    pub fn set<const N: usize, W: Weighting<N>>(&mut self, sums: &[SumRows<N>], normals: &[V3]) {
        let count = sums.len().min(normals.len()).min(TERM_BLOCK);
        let (sums, normals) = (&sums[..count], &normals[..count]);
        for i in 0..count {
            let (sum, normal) = (&sums[i], &normals[i]);
            for axis in 0..3 {
                self.normals[axis][i] = normal[axis];
                self.sums[0][axis][i] = sum[0][axis];
                self.sums[1][axis][i] = sum[1][axis];
            }
            self.sizes[i] = W::size(sum);
        }
    }

    /// Whether the tangents of the first `count` vertices are what [`crate::tangents::vertex_sums::finish`] would make of their sums one by one.
    pub fn are_sure(&self, count: usize) -> bool {
        self.sure[..count].iter().fold(1, |all, sure| all & sure) == 1
    }

    /// Computes the tangents of what was [set](FrameBlock::set). `sign`: that of all; of sums that do not split, their own.
    pub fn evaluate<const N: usize, W: Weighting<N>>(&mut self, sign: f32, width: Width) {
        width.run(FrameTask::<N, W>(self, sign, PhantomData));
    }
}

struct FrameTask<'a, const N: usize, W>(&'a mut FrameBlock, f32, PhantomData<W>);

impl<const N: usize, W: Weighting<N>> Task for FrameTask<'_, N, W> {
    #[inline(always)]
    fn run(self) {
        self.0.compute::<N, W>(self.1);
        self.0.pack();
    }
}

impl FrameBlock {
    #[inline(always)]
    fn compute<const N: usize, W: Weighting<N>>(&mut self, sign: f32) {
        for i in 0..TERM_BLOCK {
            let lane = |lanes: &[TermLane<f32>; 3]| [lanes[0][i], lanes[1][i], lanes[2][i]];
            let normal = lane(&self.normals);
            let (tangent, is_sure) = sure_tangent(lane(&self.sums[0]), normal, self.sizes[i]);
            let own_sign = if W::SPLITS { sign } else { sign_of(normal, tangent, lane(&self.sums[1])) };
            for axis in 0..3 {
                self.lanes[axis][i] = tangent[axis];
            }
            self.lanes[3][i] = own_sign;
            self.sure[i] = if is_sure { 1 } else { 0 };
        }
    }

    #[inline(always)]
    fn pack(&mut self) {
        let [x, y, z, w] = &self.lanes;
        for i in 0..TERM_BLOCK {
            self.tangents[i] = [x[i], y[i], z[i], w[i]];
        }
    }
}

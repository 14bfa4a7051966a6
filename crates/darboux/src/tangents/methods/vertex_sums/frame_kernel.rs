//! Tangents of a block of vertices from their sums.
//!
//! As in [`crate::tangents::methods::vertex_sums::term_kernel`], every quantity is an array with one lane per
//! element, and loops have no branches, so that compilers vectorise them. Lanes that are not reliable are
//! computed again one by one.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use std::marker::PhantomData;

use crate::math::V3;

use crate::exec::simd::{Task, Width};
use crate::tangents::methods::vertex_sums::frame_math::{sign_of, sure_tangent};
use crate::tangents::methods::vertex_sums::term_kernel::{TERM_BLOCK, TermLane};
use crate::tangents::methods::vertex_sums::weighting::{SumRows, Weighting};

/// The arrays of one block, reused from block to block.
pub(crate) struct FrameBlock {
    normals: [TermLane<f32>; 3],
    /// The summed tangents and bitangents.
    sums: [[TermLane<f32>; 3]; 2],
    /// [`Weighting::size`] of each sum.
    sizes: TermLane<f32>,
    /// The coordinates and signs of the tangents.
    lanes: [TermLane<f32>; 4],
    /// The tangents: xyz and sign w.
    pub tangents: TermLane<[f32; 4]>,
    /// 1 for reliable tangents, else 0.
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

    /// Loads up to [`TERM_BLOCK`] vertices. Other lanes keep their values.
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

    /// True when the tangents of the first `count` vertices are reliable: equal to what
    /// [`crate::tangents::methods::vertex_sums::finish`] computes one by one.
    pub fn are_sure(&self, count: usize) -> bool {
        self.sure[..count].iter().fold(1, |all, sure| all & sure) == 1
    }

    /// Computes the tangents of the loaded vertices.
    ///
    /// `sign`: the sign of all tangents; ignored by methods that do not split, whose signs follow from the
    /// summed bitangents.
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

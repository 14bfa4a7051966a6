//! Terms of a block of triangles: what they add to their vertices.
//!
//! Every quantity is an array with one lane per triangle, and loops have no branches, so that compilers
//! vectorise them at any width. Each lane gives the bits of
//! [`crate::tangents::methods::vertex_sums::weighting::term`], which has the same source.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use crate::tangents::methods::mesh_slices::TriangleInputs;
use crate::tangents::methods::uv_derivatives::{Orientation, ScaledDerivatives};
use crate::tangents::methods::vertex_sums::weighting::{SumRows, Weighting, term_and_test};

/// The number of triangles or vertices per block.
pub(crate) const TERM_BLOCK: usize = if cfg!(small_limits) { 2 } else { 64 };

/// One value per element of a block.
pub(crate) type TermLane<T> = [T; TERM_BLOCK];

/// The arrays of one block, reused from block to block.
pub(crate) struct TermBlock<const N: usize> {
    positions: [[TermLane<f32>; 3]; 3],
    uvs: [[TermLane<f32>; 2]; 3],
    lanes: [[TermLane<f32>; 4]; N],
    /// The orientations as numbers, as wide as the other lanes.
    sides: TermLane<u32>,
    /// The rows of the terms.
    rows: [TermLane<[f32; 4]>; N],
    /// The orientation of each triangle; `None` for triangles that are skipped.
    pub orientations: TermLane<Orientation>,
}

impl<const N: usize> TermBlock<N> {
    pub fn new() -> Self {
        Self {
            positions: [[[0.0; TERM_BLOCK]; 3]; 3],
            uvs: [[[0.0; TERM_BLOCK]; 2]; 3],
            lanes: [[[0.0; TERM_BLOCK]; 4]; N],
            sides: [0; TERM_BLOCK],
            rows: [[[0.0; 4]; TERM_BLOCK]; N],
            orientations: [Orientation::None; TERM_BLOCK],
        }
    }

    /// The term of triangle `i`.
    #[inline(always)]
    pub fn term(&self, i: usize) -> SumRows<N> {
        let mut term = [[0.0; 4]; N];
        for row in 0..N {
            term[row] = self.rows[row][i];
        }
        term
    }

    /// Loads up to [`TERM_BLOCK`] triangles. Other lanes keep their values.
    #[inline(always)]
    pub fn set(&mut self, inputs: &TriangleInputs<'_>, triangles: &[[u32; 3]]) {
        for (i, &triangle) in triangles.iter().take(TERM_BLOCK).enumerate() {
            let (positions, uvs) = inputs.values_of(triangle);
            for k in 0..3 {
                for axis in 0..3 {
                    self.positions[k][axis][i] = positions[k][axis];
                }
                for axis in 0..2 {
                    self.uvs[k][axis][i] = uvs[k][axis];
                }
            }
        }
    }

    /// Computes the terms and orientations of the loaded triangles.
    #[inline(always)]
    pub fn evaluate<W: Weighting<N>>(&mut self) {
        self.compute::<W>();
        self.pack();
    }
}

impl<const N: usize> TermBlock<N> {
    #[inline(always)]
    fn compute<W: Weighting<N>>(&mut self) {
        let Self { positions: p, uvs, .. } = self;
        for i in 0..TERM_BLOCK {
            let [a, b, c] = [0, 1, 2].map(|k| [p[k][0][i], p[k][1][i], p[k][2][i]]);
            let [s, t, u] = [0, 1, 2].map(|k| [uvs[k][0][i], uvs[k][1][i]]);
            let derivatives = ScaledDerivatives::new([&a, &b, &c], [&s, &t, &u]);
            let (term, adds) = term_and_test::<N, W>(&derivatives);
            for row in 0..N {
                for lane in 0..4 {
                    self.lanes[row][lane][i] = term[row][lane];
                }
            }
            let side = if derivatives.area > 0.0 { 0 } else { 1 };
            self.sides[i] = if adds { side } else { 2 };
        }
    }

    #[inline(always)]
    fn pack(&mut self) {
        for row in 0..N {
            let [a, b, c, d] = &self.lanes[row];
            for i in 0..TERM_BLOCK {
                self.rows[row][i] = [a[i], b[i], c[i], d[i]];
            }
        }
        for i in 0..TERM_BLOCK {
            let orientation = if self.sides[i] == 0 { Orientation::Preserves } else { Orientation::Mirrors };
            self.orientations[i] = if self.sides[i] == 2 { Orientation::None } else { orientation };
        }
    }
}

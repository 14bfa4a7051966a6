//! Quantities of vertices besides the tangent, which the corners of triangles add up to: together with the
//! tangents, or in a second pass.

use crate::exec::simd::Width;
use crate::tangents::fast::kernel::{BLOCK_SIZE, TriangleBlock};

/// A quantity of a vertex that the corners of triangles add to.
pub(crate) trait VertexQuantity: Copy + Default + Send + Sync {
    /// True where [`VertexQuantity::evaluate`] reads the angles of corners.
    const NEEDS_ANGLES: bool;

    /// Computes what the corners of a block's triangles add, from the derivatives of the triangles. May
    /// overwrite the terms of tangents.
    fn evaluate(block: &mut TriangleBlock);

    /// Adds what corner `k` of triangle `i` of an evaluated block has.
    fn add(&mut self, block: &TriangleBlock, k: usize, i: usize);

    /// Finishes vertices to which all corners have been added.
    fn finish(_width: Width, _vertices: &mut [Self]) {}
}

/// No further quantity.
impl VertexQuantity for () {
    const NEEDS_ANGLES: bool = false;

    #[inline(always)]
    fn evaluate(_block: &mut TriangleBlock) {}

    #[inline(always)]
    fn add(&mut self, _block: &TriangleBlock, _k: usize, _i: usize) {}
}

/// The quantities of consecutive vertices that one thread adds to.
pub(crate) struct QuantityRange<'a, Q> {
    /// The number of the first vertex.
    pub first: u32,
    pub quantities: &'a mut [Q],
}

impl<Q: VertexQuantity> QuantityRange<'_, Q> {
    /// Adds a block's first `count` triangles, in order, to those of their vertices that are in the range.
    /// `first`: the number from which on the block counts vertices.
    #[inline(always)]
    pub fn add(&mut self, block: &mut TriangleBlock, count: usize, first: u32) {
        Q::evaluate(block);
        let before = self.first.wrapping_sub(first);
        for i in 0..count.min(BLOCK_SIZE) {
            for k in 0..3 {
                let at = block.vertex[k][i].wrapping_sub(before) as usize;
                if let Some(quantity) = self.quantities.get_mut(at) {
                    quantity.add(block, k, i);
                }
            }
        }
    }
}

//! Angular thresholds: finds vertices around which all tangents, and all bitangents, are certainly within the
//! threshold of each other.
//!
//! A second pass keeps two bounding boxes per vertex: of the directions of its tangents and of its
//! bitangents, in the plane of the normal. Two unit vectors in a box of diagonal d have a dot product of at
//! least 1 - d^2 / 2. Where this is above the cosine of the threshold, the reference joins all triangles of
//! the vertex, so the vertex stays decided. No pairs of triangles are compared, and the order of
//! the triangles does not matter.

use crate::tangents::fast::exceptions::Exceptions;
use crate::tangents::fast::kernel::TriangleBlock;
use crate::tangents::fast::second_pass::SecondPass;
use crate::tangents::fast::vertex_quantity::VertexQuantity;

/// An allowance for rounding, as part of a dot product.
///
/// With u = 2^-24: directions are of unit length to 5 u, a dot product of two is right to 3 u, the squared
/// diagonal, at most 4, to 5 u of itself, and the difference from 1 to 2 u. That is 25 u; the allowance is
/// nearly seven times as much. Directions whose squares underflow have the mark `NEEDS_GENERAL_PATH`, so
/// their vertices are undecided.
const MARGIN: f32 = 1e-5;

/// The fast path does not run with thresholds of a larger cosine: it would decide hardly a vertex.
pub(crate) const LARGEST_COSINE: f32 = 1.0 - 2.0 * MARGIN;

/// The bounding box of a vertex's tangents, then that of its bitangents.
#[derive(Clone, Copy, Debug)]
struct DirectionBounds {
    low: [f32; 6],
    high: [f32; 6],
}

impl Default for DirectionBounds {
    fn default() -> Self {
        Self { low: [f32::INFINITY; 6], high: [f32::NEG_INFINITY; 6] }
    }
}

impl VertexQuantity for DirectionBounds {
    const NEEDS_ANGLES: bool = false;

    #[inline(always)]
    fn evaluate(block: &mut TriangleBlock) {
        block.directions();
    }

    #[inline(always)]
    fn add(&mut self, block: &TriangleBlock, k: usize, i: usize) {
        let ([a, b, c, d], [e, f]) = (block.sum[k][i], block.magnitude_sum[k][i]);
        for (lane, x) in [a, b, c, d, e, f].into_iter().enumerate() {
            self.low[lane] = if x < self.low[lane] { x } else { self.low[lane] };
            self.high[lane] = if x > self.high[lane] { x } else { self.high[lane] };
        }
    }
}

impl DirectionBounds {
    /// True when all dot products are certainly above `cosine`.
    fn is_within(&self, cosine: f32) -> bool {
        // Vertices without triangles have boxes of negative sides.
        let sides: [f32; 6] = std::array::from_fn(|lane| (self.high[lane] - self.low[lane]).max(0.0));
        let least = |[x, y, z]: [f32; 3]| 1.0 - (x * x + y * y + z * z) / 2.0 - MARGIN;
        let [a, b, c, d, e, f] = sides;
        least([a, b, c]) > cosine && least([d, e, f]) > cosine
    }
}

/// The direction bounds of a mesh's vertices. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct AngleBounds {
    bounds: Vec<DirectionBounds>,
    /// True for vertices whose directions may differ by the threshold.
    is_wide: Vec<bool>,
}

impl AngleBounds {
    /// Makes those vertices undecided whose tangents or bitangents may differ by the threshold.
    /// `flat_vertices`: those without groups, which have none.
    pub fn undecide_wide_vertices(
        &mut self,
        (pass, flat_vertices): (SecondPass<'_>, &[u32]),
        threshold_cosine: f32,
        exceptions: &mut Exceptions,
        out: &mut [[f32; 4]],
    ) {
        let list = pass.list;
        pass.run(&mut self.bounds);
        self.is_wide.clear();
        self.is_wide.extend(self.bounds.iter().map(|bounds| !bounds.is_within(threshold_cosine)));
        flat_vertices.iter().for_each(|&vertex| self.is_wide[vertex as usize] = false);
        if self.is_wide.contains(&true) {
            let entries = (0..list.count() as u32)
                .flat_map(|triangle| (3 * triangle..).zip(list.triangle(triangle)))
                .filter(|&(_, vertex)| self.is_wide[vertex as usize]);
            exceptions.undecide(&list, entries.map(|(entry, _)| entry), out);
        }
    }
}

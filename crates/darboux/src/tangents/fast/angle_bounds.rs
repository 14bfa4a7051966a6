//! Angular thresholds: vertices around which all tangents, and all bitangents, are certainly within the threshold of each other.
//!
//! Around each vertex two boxes are kept, of the directions of its tangents and of its bitangents, in its plane. No two are farther apart
//! than the box's diagonal d, and unit vectors that far apart have a dot product of 1 - d^2 / 2. So nothing is compared in pairs, and the
//! order of triangles does not matter.

use crate::Mesh;

use crate::exec::limits::RunLimits;
use crate::tangents::fast::Fans;
use crate::tangents::fast::kernel::Block;
use crate::tangents::fast::second_pass::OfVertex;
use crate::tangents::fast::source;

/// What the comparison allows for rounding, as part of a dot product.
///
/// With u = 2^-24: directions are of unit length to 5 u, a dot product of two is right to 3 u, the squared diagonal, at most 4, to 5 u of
/// itself, and what is subtracted from 1 to 2 u. That is 25 u; this is nearly seven times as much. Directions whose squares underflow are in
/// trouble, so undecided.
const MARGIN: f32 = 1e-5;

/// At thresholds of a larger cosine hardly a vertex would be decided.
pub(crate) const LARGEST_COSINE: f32 = 1.0 - 2.0 * MARGIN;

/// The box of tangents, then that of bitangents.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spread {
    low: [f32; 6],
    high: [f32; 6],
}

impl Default for Spread {
    fn default() -> Self {
        Self { low: [f32::INFINITY; 6], high: [f32::NEG_INFINITY; 6] }
    }
}

impl OfVertex for Spread {
    #[inline(always)]
    fn evaluate(block: &mut Block) {
        block.evaluate_directions();
    }

    #[inline(always)]
    fn add(&mut self, block: &Block, k: usize, i: usize) {
        let ([a, b, c, d], [e, f]) = (block.sum[k][i], block.magnitude_sum[k][i]);
        for (lane, x) in [a, b, c, d, e, f].into_iter().enumerate() {
            self.low[lane] = if x < self.low[lane] { x } else { self.low[lane] };
            self.high[lane] = if x > self.high[lane] { x } else { self.high[lane] };
        }
    }
}

impl Spread {
    /// True when all dot products are above a cosine.
    fn is_within(&self, cosine: f32) -> bool {
        // Vertices without triangles have boxes of negative sides.
        let sides: [f32; 6] = std::array::from_fn(|lane| (self.high[lane] - self.low[lane]).max(0.0));
        let least = |[x, y, z]: [f32; 3]| 1.0 - (x * x + y * y + z * z) / 2.0 - MARGIN;
        let [a, b, c, d, e, f] = sides;
        least([a, b, c]) > cosine && least([d, e, f]) > cosine
    }
}

impl Fans {
    /// Leaves the vertices of the mesh that this has just run on undecided where tangents or bitangents may be apart by the threshold.
    pub(crate) fn leave_spread(
        &mut self,
        mesh: &Mesh<'_>,
        threshold_cosine: f32,
        limits: RunLimits<'_>,
        out: &mut [[f32; 4]],
    ) {
        let mut spreads = std::mem::take(&mut self.spreads);
        self.add_again(mesh, limits, &mut spreads);
        self.are_apart.clear();
        self.are_apart.extend(spreads.iter().map(|spread| !spread.is_within(threshold_cosine)));
        self.spreads = spreads;
        if self.are_apart.contains(&true) {
            let (source, are_apart) = (source(mesh, &self.weld, &self.cut), &self.are_apart);
            let entries = (0..source.count() as u32)
                .flat_map(|triangle| (3 * triangle..).zip(source.triangle(triangle)))
                .filter(|&(_, vertex)| are_apart[vertex as usize]);
            self.special.leave(&source, entries.map(|(entry, _)| entry), out);
        }
    }
}

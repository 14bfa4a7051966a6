//! The mean of the adjacent triangles' unit tangents and bitangents: every triangle counts the same.
//!
//! Each vertex's mean is what it would gather over its adjacency, triangle by triangle. Where the triangles around it lie near each other in the
//! list, adding each to its three vertices gives the same bits sooner (docs/notes/methods.md); where not, they are gathered (gather.rs).

use crate::tangents::uv_derivatives::ScaledDerivatives;
use crate::tangents::vertex_sums::weighting::{SumRows, Weighting};

/// Weight one for every triangle.
pub(crate) struct Average;

impl Weighting<3> for Average {
    #[inline(always)]
    fn term(derivatives: &ScaledDerivatives) -> SumRows<3> {
        let ([[s0, s1, s2], [t0, t1, t2]], [m0, m1]) = derivatives.directions();
        [[s0, s1, s2, 1.0], [t0, t1, t2, m0], [0.0, 0.0, 0.0, m1]]
    }

    fn size(sum: &SumRows<3>) -> f32 {
        sum[0][3]
    }

    fn magnitude([[_, _, _, count], [_, _, _, m0], [_, _, _, m1]]: &SumRows<3>) -> [f32; 2] {
        [m0 / count, m1 / count]
    }
}

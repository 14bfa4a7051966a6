//! The mean of the unit tangents and bitangents of the triangles around a vertex, all weighted alike.

use crate::tangents::methods::uv_derivatives::ScaledDerivatives;
use crate::tangents::methods::vertex_sums::weighting::{SumRows, Weighting};

/// Every triangle has weight 1.
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

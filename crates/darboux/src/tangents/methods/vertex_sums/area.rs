//! Unit tangents, bitangents and normals of the triangles around a vertex, weighted by the triangles' areas.
//!
//! The area vector cross(e1, e2) / 2 gives both the normal and the weight. Its sum over a fan is the "area
//! weighted" normal of G. Thürmer and C. A. Wüthrich, "Computing Vertex Normals from Polygonal Facets", 1998
//! (who recommend weights by angle).

use crate::math::{V3, length, scale};

use crate::tangents::methods::uv_derivatives::ScaledDerivatives;
use crate::tangents::methods::vertex_sums::weighting::{SumRows, Weighting};

/// Weights by area. The summed normal replaces an absent normal of the mesh.
pub(crate) struct Area;

impl Weighting<3> for Area {
    #[inline(always)]
    fn term(derivatives: &ScaledDerivatives) -> SumRows<3> {
        let normal = derivatives.doubled_area_vector();
        let weight = length(normal);
        let ([s, t], magnitude) = derivatives.directions();
        let ([s0, s1, s2], [t0, t1, t2]) = (scale(weight, s), scale(weight, t));
        let [m0, m1] = [weight * magnitude[0], weight * magnitude[1]];
        [[s0, s1, s2, weight], [t0, t1, t2, m0], [normal[0], normal[1], normal[2], m1]]
    }

    fn size(sum: &SumRows<3>) -> f32 {
        sum[0][3]
    }

    fn magnitude([[_, _, _, weight], [_, _, _, m0], [_, _, _, m1]]: &SumRows<3>) -> [f32; 2] {
        [m0 / weight, m1 / weight]
    }

    fn own_normal([_, _, [x, y, z, _]]: &SumRows<3>) -> V3 {
        [*x, *y, *z]
    }
}

//! Lengyel's method: the sum of the derivatives of the triangles around a vertex, not normalised.
//!
//! Source: E. Lengyel, "Computing Tangent Space Basis Vectors for an Arbitrary Mesh", 2001; "Foundations of
//! Game Engine Development", vol. 2, 2019, section 7.5. The derivation is in docs/algorithms/methods.md.

use crate::math::{length, scale};

use crate::tangents::methods::uv_derivatives::{ScaledDerivatives, size};
use crate::tangents::methods::vertex_sums::weighting::{SumRows, Weighting};

/// Each triangle adds dP/du and dP/dv. The two UV orientations have separate sums.
pub(crate) struct Lengyel;

impl Weighting<2> for Lengyel {
    #[inline(always)]
    fn term(derivatives: &ScaledDerivatives) -> SumRows<2> {
        let reciprocal = 1.0 / derivatives.area;
        let (s, [t0, t1, t2]) = (scale(reciprocal, derivatives.s), scale(reciprocal, derivatives.t));
        [[s[0], s[1], s[2], 1.0], [t0, t1, t2, size(s)]]
    }

    fn size(sum: &SumRows<2>) -> f32 {
        sum[1][3]
    }

    fn magnitude([[s0, s1, s2, count], [t0, t1, t2, _]]: &SumRows<2>) -> [f32; 2] {
        [[*s0, *s1, *s2], [*t0, *t1, *t2]].map(|sum| length(sum) / count)
    }
}

/// As [`Lengyel`], but with one sum per vertex for both orientations, as in three.js and many tutorials.
pub(crate) struct LengyelPerVertex;

impl Weighting<2> for LengyelPerVertex {
    const SPLITS: bool = false;

    #[inline(always)]
    fn term(derivatives: &ScaledDerivatives) -> SumRows<2> {
        Lengyel::term(derivatives)
    }

    fn size(sum: &SumRows<2>) -> f32 {
        Lengyel::size(sum)
    }

    fn magnitude(sum: &SumRows<2>) -> [f32; 2] {
        Lengyel::magnitude(sum)
    }
}

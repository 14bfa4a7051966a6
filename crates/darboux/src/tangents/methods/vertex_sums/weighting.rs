//! [`Weighting`]: what defines a method of this folder, namely the term that a triangle adds to each of its
//! vertices.
//!
//! accumulate.rs adds the terms, finish.rs computes frames from the sums.

use crate::math::V3;

use crate::tangents::methods::mesh_slices::MeshSlices;
use crate::tangents::methods::uv_derivatives::{ScaledDerivatives, size};

/// A term or a sum as `N` rows of four lanes, so that one addition is `N` vector additions. Row 0 is a
/// tangent and a weight; row 1 begins with a bitangent.
pub(crate) type SumRows<const N: usize> = [[f32; 4]; N];

/// A method in which a triangle adds the same term to each of its vertices.
pub(crate) trait Weighting<const N: usize> {
    /// False: both orientations share one sum, and the sign follows from the summed bitangent.
    const SPLITS: bool = true;

    /// The term of a triangle. Triangles are skipped whose weight is not above zero, or with a lane that is
    /// not finite.
    fn term(derivatives: &ScaledDerivatives) -> SumRows<N>;

    /// The sum of the lengths of the added tangents, within a factor of two. A sum that is much shorter has
    /// cancelled.
    fn size(sum: &SumRows<N>) -> f32;

    /// The lengths of dP/du and dP/dv of a sum.
    fn magnitude(sum: &SumRows<N>) -> [f32; 2];

    /// The normal that replaces an absent normal of the mesh; not normalised. Zero if the method sums none.
    fn own_normal(_sum: &SumRows<N>) -> V3 {
        [0.0; 3]
    }
}

/// The term of a triangle, and whether it is added. No branches.
#[inline(always)]
pub(crate) fn term_and_test<const N: usize, W: Weighting<N>>(
    derivatives: &ScaledDerivatives,
) -> (SumRows<N>, bool) {
    let term = W::term(derivatives);
    // One test for all lanes: absolute values do not cancel, so their sum is finite only if all lanes are.
    let mut sizes = 0.0;
    for [a, b, c, d] in term {
        sizes += size([a, b, c]) + d.abs();
    }
    let is_finite = sizes < f32::INFINITY;
    (term, derivatives.has_direction() & is_finite & (term[0][3] > 0.0))
}

/// The term of a triangle; `None` for triangles that are skipped.
#[inline(always)]
pub(crate) fn term<const N: usize, W: Weighting<N>>(derivatives: &ScaledDerivatives) -> Option<SumRows<N>> {
    let (term, adds) = term_and_test::<N, W>(derivatives);
    adds.then_some(term)
}

/// True for triangles that are not skipped.
pub(crate) fn adds<const N: usize, W: Weighting<N>>(slices: &MeshSlices<'_>, t: usize) -> bool {
    let inputs = slices.triangle_inputs();
    let (positions, uvs) = inputs.values_of(inputs.triangles[t]);
    term::<N, W>(&ScaledDerivatives::new(positions, uvs)).is_some()
}

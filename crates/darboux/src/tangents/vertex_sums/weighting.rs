//! Sums over the triangles around each vertex, apart for the two UV orientations.
//!
//! What a triangle adds is a method's business ([`Weighting`]); how it is added is in accumulate.rs, what becomes of the sums in sides.rs.

use crate::math::V3;

use crate::tangents::mesh_slices::MeshSlices;
use crate::tangents::uv_derivatives::{ScaledDerivatives, size};

/// Rows of four lanes, so that a sum is `N` vector additions. Row 0 is a tangent and a weight, row 1 begins with a bitangent.
pub(crate) type SumRows<const N: usize> = [[f32; 4]; N];

/// A method that sums what each triangle adds to all of its vertices alike.
pub(crate) trait Weighting<const N: usize> {
    /// False: both orientations share one sum, and the sign is the one that the summed bitangent asks for.
    const SPLITS: bool = true;

    /// What a triangle adds. One without a weight above zero, or with a lane that is not finite, adds nothing.
    fn term(derivatives: &ScaledDerivatives) -> SumRows<N>;

    /// What the lengths of the added tangents come to, to a factor of two: a sum that is much shorter cancelled.
    fn size(sum: &SumRows<N>) -> f32;

    /// The lengths of dP/du and dP/dv that a sum stands for.
    fn magnitude(sum: &SumRows<N>) -> [f32; 2];

    /// A normal to use where the mesh has none, as long as it may be.
    fn own_normal(_sum: &SumRows<N>) -> V3 {
        [0.0; 3]
    }
}

/// What a triangle adds, and whether it adds it. No branches.
#[inline(always)]
pub(crate) fn term_and_test<const N: usize, W: Weighting<N>>(
    derivatives: &ScaledDerivatives,
) -> (SumRows<N>, bool) {
    let term = W::term(derivatives);
    // One test for all lanes: sizes do not cancel, so their sum is finite only where all are.
    let mut sizes = 0.0;
    for [a, b, c, d] in term {
        sizes += size([a, b, c]) + d.abs();
    }
    let is_finite = sizes < f32::INFINITY;
    (term, derivatives.has_direction() & is_finite & (term[0][3] > 0.0))
}

/// What a triangle adds; none when it adds nothing.
#[inline(always)]
pub(crate) fn term<const N: usize, W: Weighting<N>>(derivatives: &ScaledDerivatives) -> Option<SumRows<N>> {
    let (term, adds) = term_and_test::<N, W>(derivatives);
    adds.then_some(term)
}

/// True for a triangle that adds something.
pub(crate) fn adds<const N: usize, W: Weighting<N>>(flat: &MeshSlices<'_>, t: usize) -> bool {
    let slices = flat.slices();
    let (positions, uvs) = slices.refer(slices.triangles[t]);
    term::<N, W>(&ScaledDerivatives::new(positions, uvs)).is_some()
}

//! The derivatives dP/du and dP/dv of each triangle, and the orientation of its UV map.
//!
//! Source: mikktspace.c, `InitTriInfo`, equations 18 and 19.

use crate::math::{V3, add, length, not_zero, scale, sub};
use crate::topology::triangles::{NONE, Triangles};

use crate::exec::limits::RunLimits;
use crate::exec::threads;
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;
use crate::tangents::report::are_finite;

/// One triangle's derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Derivative {
    /// The direction of dP/du: a unit vector, except on UV-degenerate triangles.
    pub s: V3,
    /// The direction of dP/dv: a unit vector, except on UV-degenerate triangles.
    pub t: V3,
    /// The lengths of dP/du and dP/dv.
    pub magnitude: [f32; 2],
    /// True when the UV map preserves the triangle's orientation.
    pub preserves: bool,
    /// True for UV-degenerate triangles: they join groups of either orientation, and add nothing to tangents
    /// (`GROUP_WITH_ANY`).
    pub joins_any: bool,
}

/// Computes the derivatives of every triangle. There are fewer after cancellation.
pub(crate) fn derivatives(
    triangles: &Triangles,
    welded: &WeldedMesh<'_>,
    limits: RunLimits<'_>,
) -> Vec<Derivative> {
    threads::map(limits, triangles.len(), |t| {
        derivative(welded.positions(triangles, t), welded.uvs(triangles, t))
    })
}

/// As [`derivatives`], into a reused buffer.
pub(crate) fn derivatives_into(
    triangles: &Triangles,
    welded: &WeldedMesh<'_>,
    limits: RunLimits<'_>,
    derivatives: &mut Vec<Derivative>,
) {
    let none =
        Derivative { s: [0.0; 3], t: [0.0; 3], magnitude: [0.0; 2], preserves: false, joins_any: true };
    derivatives.resize(triangles.len(), none);
    threads::fill(limits, derivatives, |t| {
        derivative(welded.positions(triangles, t), welded.uvs(triangles, t))
    });
}

/// The derivatives of a triangle.
pub(crate) fn derivative(positions: [V3; 3], uvs: [[f32; 2]; 3]) -> Derivative {
    let [e1, e2] = [sub(positions[1], positions[0]), sub(positions[2], positions[0])];
    let [du1, dv1] = [uvs[1][0] - uvs[0][0], uvs[1][1] - uvs[0][1]];
    let [du2, dv2] = [uvs[2][0] - uvs[0][0], uvs[2][1] - uvs[0][1]];
    let s = sub(scale(dv2, e1), scale(dv1, e2));
    let t = add(scale(-du2, e1), scale(du1, e2));
    let area = doubled_area(uvs);
    let mut out = Derivative { s, t, magnitude: [0.0; 2], preserves: area > 0.0, joins_any: true };
    if not_zero(area) {
        let sign = if out.preserves { 1.0 } else { -1.0 };
        let (s_length, t_length) = (length(s), length(t));
        out.s = if not_zero(s_length) { scale(sign / s_length, s) } else { s };
        out.t = if not_zero(t_length) { scale(sign / t_length, t) } else { t };
        out.magnitude = [s_length / area.abs(), t_length / area.abs()];
        out.joins_any = !out.magnitude.iter().all(|&magnitude| not_zero(magnitude));
    }
    out
}

/// The number of UV-degenerate triangles with finite positions and UVs.
pub(crate) fn count_uv_degenerate(
    triangles: &Triangles,
    welded: &WeldedMesh<'_>,
    derivatives: &[Derivative],
) -> usize {
    let finite = |t| are_finite(welded.positions(triangles, t), welded.uvs(triangles, t));
    derivatives.iter().enumerate().filter(|(t, derivative)| derivative.joins_any && finite(*t)).count()
}

/// Twice the signed area of a triangle in UV space.
#[inline(always)]
pub(crate) fn doubled_area(uvs: [[f32; 2]; 3]) -> f32 {
    let [du1, dv1] = [uvs[1][0] - uvs[0][0], uvs[1][1] - uvs[0][1]];
    let [du2, dv2] = [uvs[2][0] - uvs[0][0], uvs[2][1] - uvs[0][1]];
    du1 * dv2 - dv1 * du2
}

/// Sets one orientation for both halves of each quad: the first half's, if the second is UV-degenerate or not
/// larger in UV space.
pub(crate) fn unify_quads(triangles: &Triangles, welded: &WeldedMesh<'_>, derivatives: &mut [Derivative]) {
    let mut t = 0;
    while t < triangles.len() {
        if !triangles.is_pair(t) {
            t += 1;
            continue;
        }
        let area = |t| doubled_area(welded.uvs(triangles, t)).abs();
        let first_decides = derivatives[t + 1].joins_any || area(t) >= area(t + 1);
        let preserves = derivatives[if first_decides { t } else { t + 1 }].preserves;
        derivatives[t].preserves = preserves;
        derivatives[t + 1].preserves = preserves;
        t += 2;
    }
}

/// Computes the derivatives of every triangle, with one orientation per quad. There are fewer after
/// cancellation.
pub(crate) fn quad_derivatives(
    good: &Triangles,
    welded: &WeldedMesh<'_>,
    limits: RunLimits<'_>,
) -> Vec<Derivative> {
    let mut derivatives = derivatives(good, welded, limits);
    if !limits.is_cancelled() {
        unify_quads(good, welded, &mut derivatives);
    }
    derivatives
}

/// The number of edges between two triangles of opposite orientation, neither of which is UV-degenerate.
pub(crate) fn count_mirrored_edges(neighbours: &[[u32; 3]], derivatives: &[Derivative]) -> usize {
    let mirrored = |t: usize, other: u32| {
        other != NONE && (t as u32) < other && {
            let (a, b) = (&derivatives[t], &derivatives[other as usize]);
            !a.joins_any && !b.joins_any && a.preserves != b.preserves
        }
    };
    let of_triangle =
        |(t, around): (usize, &[u32; 3])| around.iter().filter(|&&other| mirrored(t, other)).count();
    neighbours.iter().enumerate().map(of_triangle).sum()
}

//! Bounds of the rounding errors of tangents of plans in fast precision, derived from the guarantees of WGSL.
//!
//! With u = 2^-24, as in bound.rs: dP/du has an error of 4 u M, where M = |dv2| |e1| + |dv1| |e2|.
//! Normalising a vector doubles its relative error and adds 20 u. Projecting a unit vector with error e into
//! the plane of the normal, where it has length r, adds 60 u, so its direction has an error of D = (2 e + 120
//! u) / r + 20 u. The cosine of a corner has an error of C = D + D' + 3 u, its angle w of A = min(C / sin w,
//! sqrt(2 C)) + 1e-6, where the last term is for the arccosine. A sum of n terms w s has an error of the sum
//! of w D + A, plus n u times the sum of w for the additions. Its direction has twice that error divided by
//! its length, plus 20 u.

use darboux::internal::stage_arrays::Stages;
use darboux_tests::OwnedMesh;

use super::bound::{U, dot, length, sub};

type V3 = [f64; 3];

/// Above this, and below its reciprocal, squares may overflow or underflow.
const LARGEST: f64 = 1e15;

/// The bound of every sum; none if it is larger than 0.1.
pub fn bounds(base: &Stages, moved: &OwnedMesh) -> Vec<Option<f64>> {
    let starts = [0].into_iter().chain(base.sums.ends.iter().copied());
    let sum = |(start, (&end, &vertex)): (u32, (&u32, &u32))| {
        let normal = moved.normals[moved.vertex_of_corner(vertex as usize)].map(f64::from);
        let terms = base.sums.members[start as usize..end as usize].iter().map(|&member| {
            let good = &base.triangulation.good;
            let corners =
                good.corners[member as usize / 3].map(|corner| moved.vertex_of_corner(corner as usize));
            term(moved, corners, member as usize % 3, normal)
        });
        let terms: Option<Vec<_>> = terms.collect();
        of_terms(&terms?).filter(|bound| *bound < 0.1)
    };
    starts.zip(base.sums.ends.iter().zip(&base.sums.vertices)).map(sum).collect()
}

/// The term of a corner: its direction, the error of the direction, its weight, the error of the weight.
type Term = (V3, f64, f64, f64);

fn of_terms(terms: &[Term]) -> Option<f64> {
    let (mut total, mut error, mut weights) = ([0.0; 3], 0.0, 0.0);
    for (direction, off, weight, weight_off) in terms {
        total = [0, 1, 2].map(|i| total[i] + weight * direction[i]);
        error += weight * off + weight_off;
        weights += weight;
    }
    error += terms.len() as f64 * U * weights;
    let size = length(total);
    (size > 1.0 / LARGEST).then(|| 2.0 * error / size + 20.0 * U)
}

fn term(mesh: &OwnedMesh, vertices: [usize; 3], k: usize, normal: V3) -> Option<Term> {
    let at = vertices.map(|v| mesh.positions[v].map(f64::from));
    let uv = vertices.map(|v| mesh.uvs[v].map(f64::from));
    let (e1, e2) = (sub(at[1], at[0]), sub(at[2], at[0]));
    let [dv1, dv2] = [uv[1][1] - uv[0][1], uv[2][1] - uv[0][1]];
    let area = (uv[1][0] - uv[0][0]) * dv2 - dv1 * (uv[2][0] - uv[0][0]);
    let s = [0, 1, 2].map(|i| area.signum() * (dv2 * e1[i] - dv1 * e2[i]));
    let scale = dv2.abs() * length(e1) + dv1.abs() * length(e2);
    let is_sized = |x: f64| (1.0 / LARGEST..LARGEST).contains(&x);
    if !is_sized(length(s)) || !(0.99..1.01).contains(&length(normal)) {
        return None;
    }
    let (direction, off) = in_plane(normal, s, 4.0 * U * scale / length(s))?;
    let edge = |to: usize| {
        let edge = sub(at[to % 3], at[k]);
        is_sized(length(edge)).then(|| in_plane(normal, edge, U))?
    };
    let ((before, before_off), (after, after_off)) = (edge(k + 2)?, edge(k + 1)?);
    let angle = dot(before, after).clamp(-1.0, 1.0).acos();
    let cosine_off = before_off + after_off + 3.0 * U;
    let weight_off = (cosine_off / (angle.sin() - cosine_off.sqrt()).max(0.0)).min((2.0 * cosine_off).sqrt());
    Some((direction, off, angle, 2.0 * weight_off + 1e-6))
}

/// The direction of `v` in the plane of `normal`, and its error. `off`: the relative error of `v`.
fn in_plane(normal: V3, v: V3, off: f64) -> Option<(V3, f64)> {
    let v = v.map(|x| x / length(v));
    let along = dot(normal, v);
    let rest = [0, 1, 2].map(|i| v[i] - along * normal[i]);
    let size = length(rest);
    (size > 1e-4).then(|| (rest.map(|x| x / size), (2.0 * off + 120.0 * U) / size + 20.0 * U))
}

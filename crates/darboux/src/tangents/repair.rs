//! The test of usable tangents, and the vectors that replace unusable ones.
//!
//! All results are the same bits on every platform: `f64`, and only additions, products, quotients and square
//! roots.

use crate::math::{V3, not_zero};
use crate::math_f64::{D3, cross, dot, length, unit};

/// sign * cross(normal, tangent), normalised. Without a normal, or with a tangent along it, a perpendicular
/// of the tangent.
pub(crate) fn bitangent(normal: Option<D3>, tangent: V3, sign: f32) -> V3 {
    let tangent = tangent.map(f64::from);
    let across = normal.and_then(|normal| unit(cross(normal, tangent)));
    across.unwrap_or_else(|| perpendicular(tangent)).map(|x| (f64::from(sign) * x) as f32)
}

/// As [`bitangent`], from a normal in `f32`, which may be zero.
pub(crate) fn across(normal: V3, tangent: V3, sign: f32) -> V3 {
    bitangent(direction(normal), tangent, sign)
}

/// The direction of dP/du on a triangle, not normalised. Zero or NaN where positions or UVs give none.
pub(crate) fn u_direction_of(positions: [V3; 3], uvs: [[f32; 2]; 3]) -> D3 {
    let [p0, p1, p2] = positions.map(|position| position.map(f64::from));
    let [t0, t1, t2] = uvs.map(|uv| uv.map(f64::from));
    let [dv1, dv2] = [t1[1] - t0[1], t2[1] - t0[1]];
    let area = (t1[0] - t0[0]) * dv2 - dv1 * (t2[0] - t0[0]);
    // `signum` of NaN is NaN. The sign bit of a NaN area (from infinite UVs) differs between processors and
    // must not decide.
    [0, 1, 2].map(|i| (dv2 * (p1[i] - p0[i]) - dv1 * (p2[i] - p0[i])) * area.signum())
}

/// True for a finite tangent of unit length (within 1e-3) that is not along the normal (|cos| < 0.999).
/// Normals may be zero.
pub(crate) fn is_usable(tangent: V3, normal: V3) -> bool {
    let has_normal = is_not_zero(normal);
    let (tangent, normal) = (tangent.map(f64::from), normal.map(f64::from));
    let length_of_tangent = length(tangent);
    // Written so that NaN and infinity fail.
    (length_of_tangent - 1.0).abs() < 1e-3
        && (!has_normal || dot(tangent, normal).abs() < 0.999 * length_of_tangent * length(normal))
}

/// The direction of the sum of `directions`, each projected to the tangent plane and normalised. `None` where
/// the sum cancels or there is no normal.
pub(crate) fn mean_in_plane(directions: impl Iterator<Item = V3>, normal: V3) -> Option<V3> {
    let normal = direction(normal)?;
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for direction in directions {
        if let Some(direction) = in_plane(direction.map(f64::from), normal) {
            sum = [sum[0] + direction[0], sum[1] + direction[1], sum[2] + direction[2]];
            count += 1.0;
        }
    }
    // A sum of vectors that cancel is rounding error.
    if length(sum) > 1e-6 * count { Some(in_plane(sum, normal)?.map(|x| x as f32)) } else { None }
}

/// `v`, projected to the plane of the unit `normal` and normalised. `None` where the projection is rounding
/// error.
pub(crate) fn in_plane(v: D3, normal: D3) -> Option<D3> {
    let v = unit(v)?;
    let along = dot(v, normal);
    let rest = [0, 1, 2].map(|i| v[i] - along * normal[i]);
    if length(rest) > 1e-6 { unit(rest) } else { None }
}

/// A unit vector perpendicular to the unit `normal` (Duff et al. 2017, "Building an Orthonormal Basis,
/// Revisited", listing 3).
pub(crate) fn perpendicular(normal: D3) -> D3 {
    let [x, y, z] = normal;
    let sign = 1f64.copysign(z);
    let a = -1.0 / (sign + z);
    [1.0 + sign * x * x * a, sign * (x * y * a), -sign * x]
}

/// `normal`, normalised. `None` where it is zero.
pub(crate) fn direction(normal: V3) -> Option<D3> {
    if is_not_zero(normal) { unit(normal.map(f64::from)) } else { None }
}

fn is_not_zero(v: V3) -> bool {
    v.iter().any(|&x| not_zero(x))
}

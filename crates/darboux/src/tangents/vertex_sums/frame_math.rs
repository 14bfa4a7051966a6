//! The tangent, the bitangent and the sign that a vertex's sum stands for.
//!
//! Each direction has a fast form in `f32` without branches, which also says whether its result is reliable, and a precise one in `f64`.

use crate::math::{V3, dot, scale, sub};

use crate::tangents::repair::{direction, in_plane, unit};

/// The direction of a sum of tangents in the plane of the normal, and whether it is that: nearly always, as normals are nearly unit vectors.
///
/// `size`: what the lengths of the added tangents come to.
#[inline(always)]
pub(crate) fn sure_tangent(s: V3, normal: V3, size: f32) -> (V3, bool) {
    let (direction, is_sure) = sure_direction_across(s, normal);
    (direction, is_sure & !cancels(s, size))
}

/// What is left of tangents that cancel is rounding.
#[inline(always)]
pub(crate) fn cancels(s: V3, size: f32) -> bool {
    let least = 1e-5 * size;
    dot(s, s) < least * least
}

/// The sign for which sign * cross(normal, tangent) is on the bitangent's side; +1 where it is on neither.
#[inline(always)]
pub(crate) fn sign_of(normal: V3, tangent: V3, bitangent: V3) -> f32 {
    let ([a, b, c], [x, y, z]) = (normal, tangent);
    let across = [b * z - c * y, c * x - a * z, a * y - b * x];
    if dot(across, bitangent) < 0.0 { -1.0 } else { 1.0 }
}

/// The direction of `v` in the plane of `normal`; without a normal the direction of `v`.
#[inline(always)]
pub(crate) fn direction_across(v: V3, normal: V3) -> Option<V3> {
    let (direction, is_sure) = sure_direction_across(v, normal);
    if is_sure { Some(direction) } else { precise_direction_across(v, normal) }
}

/// The direction of `v` in the plane of `normal`, and whether it is that. No branches.
#[inline(always)]
fn sure_direction_across(v: V3, normal: V3) -> (V3, bool) {
    let square = dot(normal, normal);
    let is_about_unit = (0.25..4.0).contains(&square);
    let rest = sub(v, scale(dot(normal, v) * (1.0 / square), normal));
    let size = dot(rest, rest);
    // Far from overflow, and with enough left of `v` to be sure of the angle. NaN is not.
    let is_clear = (size > 1e-2 * dot(v, v)) & (size > 1e-24) & (size < 1e24);
    (scale(1.0 / size.sqrt(), rest), is_about_unit & is_clear)
}

#[cold]
pub(crate) fn precise_direction_across(v: V3, normal: V3) -> Option<V3> {
    let v = v.map(f64::from);
    let found = match direction(normal) {
        Some(normal) => in_plane(v, normal),
        None => unit(v),
    };
    found.map(|v| v.map(|x| x as f32))
}

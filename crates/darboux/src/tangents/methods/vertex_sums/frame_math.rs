//! Directions in the tangent plane and signs, as [`crate::tangents::methods::vertex_sums::finish`] and its
//! kernel compute them.
//!
//! Each direction has a fast form in `f32` without branches, which also returns whether the result is
//! reliable, and a precise form in `f64` for the rest.

use crate::math::{V3, dot, scale, sub};

use crate::math_f64::unit;
use crate::tangents::repair::{direction, in_plane};

/// The direction of a sum of tangents in the tangent plane, and whether it is reliable.
///
/// `size`: the approximate sum of the lengths of the added tangents.
#[inline(always)]
pub(crate) fn sure_tangent(s: V3, normal: V3, size: f32) -> (V3, bool) {
    let (direction, is_sure) = sure_direction_across(s, normal);
    (direction, is_sure & !cancels(s, size))
}

/// True when the added tangents cancel, so that their sum is rounding error.
#[inline(always)]
pub(crate) fn cancels(s: V3, size: f32) -> bool {
    let least = 1e-5 * size;
    dot(s, s) < least * least
}

/// The sign for which sign * cross(normal, tangent) points to the side of the bitangent. +1 where it is
/// perpendicular.
#[inline(always)]
pub(crate) fn sign_of(normal: V3, tangent: V3, bitangent: V3) -> f32 {
    let ([a, b, c], [x, y, z]) = (normal, tangent);
    let across = [b * z - c * y, c * x - a * z, a * y - b * x];
    if dot(across, bitangent) < 0.0 { -1.0 } else { 1.0 }
}

/// The direction of `v` in the tangent plane; without a normal, the direction of `v`.
#[inline(always)]
pub(crate) fn direction_across(v: V3, normal: V3) -> Option<V3> {
    let (direction, is_sure) = sure_direction_across(v, normal);
    if is_sure { Some(direction) } else { precise_direction_across(v, normal) }
}

/// The direction of `v` in the tangent plane, and whether it is reliable. No branches.
#[inline(always)]
fn sure_direction_across(v: V3, normal: V3) -> (V3, bool) {
    let square = dot(normal, normal);
    let is_about_unit = (0.25..4.0).contains(&square);
    let rest = sub(v, scale(dot(normal, v) * (1.0 / square), normal));
    let size = dot(rest, rest);
    // Far from overflow, and with a large enough part of `v` in the plane. False for NaN.
    let is_clear = (size > 1e-2 * dot(v, v)) & (size > 1e-24) & (size < 1e24);
    (scale(1.0 / size.sqrt(), rest), is_about_unit & is_clear)
}

/// As [`direction_across`], in `f64`.
#[cold]
pub(crate) fn precise_direction_across(v: V3, normal: V3) -> Option<V3> {
    let v = v.map(f64::from);
    let found = match direction(normal) {
        Some(normal) => in_plane(v, normal),
        None => unit(v),
    };
    found.map(|v| v.map(|x| x as f32))
}

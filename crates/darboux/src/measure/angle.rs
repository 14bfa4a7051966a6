//! Angles between tangents.

use crate::math::V3;
use crate::math_f64::{D3, cross, dot, length, unit};

/// The direction of a tangent.
pub(super) fn xyz([x, y, z, _]: [f32; 4]) -> V3 {
    [x, y, z]
}

/// The angle in degrees, by the arctangent, which is accurate for small and large angles. `None` where a
/// vector is zero or not finite.
pub(super) fn angle_of(a: D3, b: D3) -> Option<f64> {
    let [a, b] = [unit(a)?, unit(b)?];
    Some(length(cross(a, b)).atan2(dot(a, b)).to_degrees())
}

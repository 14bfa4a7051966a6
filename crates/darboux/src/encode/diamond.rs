//! A tangent as one number: its place around the normal, counted from a perpendicular that normal alone determines.
//!
//! The number is not the angle but the place on the diamond |x| + |y| = 1, which needs neither sine nor cosine: those differ from one
//! GPU to the next, by up to 2^-11 in Vulkan, four times the step here.
//!
//! Source: J. Ong, "Tangent Spaces and Diamond Encoding", 2023. The perpendicular is Duff's (2017).
//!
//! Error: 2^15 steps make a turn of 4. The direction turns by at most twice a step, as the diamond's sides are 1 / sqrt(2) from its
//! centre, and rounding moves it by half a step: 4 / 2^15 radians.

use crate::math::{add, dot, perpendiculars, scale};

const STEPS_OF_SIDE: f32 = 8192.0;

/// Two bytes: 15 bits for the place and, as the lowest, one that is set where w is -1. Directions turn by up to 0.0071 degrees.
///
/// `normal`: unit, and bit for bit what the decoder will be given: decoded itself, where it is stored in fewer bytes. What of the
/// tangent lies along it is lost.
pub fn tangent_to_diamond(normal: [f32; 3], [x, y, z, w]: [f32; 4]) -> u16 {
    let [first, second] = perpendiculars(normal);
    let tangent = [x, y, z];
    let [x, y] = [dot(tangent, first), dot(tangent, second)];
    let size = x.abs() + y.abs();
    let place = if y < 0.0 { 3.0 + x / size } else { 1.0 - x / size };
    let step = (place * STEPS_OF_SIDE).round() as u16 & 0x7fff;
    step << 1 | u16::from(w < 0.0)
}

/// The unit tangent of [`tangent_to_diamond`].
///
/// `normal`: unit, the same bits as the encoder was given.
pub fn tangent_from_diamond(normal: [f32; 3], code: u16) -> [f32; 4] {
    let place = f32::from(code >> 1) / STEPS_OF_SIDE;
    let is_below = place >= 2.0;
    let x = if is_below { place - 3.0 } else { 1.0 - place };
    let y = if is_below { x.abs() - 1.0 } else { 1.0 - x.abs() };
    let [first, second] = perpendiculars(normal);
    let tangent = add(scale(x, first), scale(y, second));
    let [x, y, z] = scale(1.0 / dot(tangent, tangent).sqrt(), tangent);
    [x, y, z, if code & 1 == 0 { 1.0 } else { -1.0 }]
}

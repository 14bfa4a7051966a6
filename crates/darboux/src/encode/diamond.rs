//! Diamond encoding: a tangent as one number, its position around the normal, counted from a perpendicular of
//! the normal.
//!
//! The number is not the angle but the position on the diamond |x| + |y| = 1, which needs neither sine nor
//! cosine. Those differ between GPUs, by up to 2^-11 in Vulkan, four times the step of this encoding.
//!
//! Source: J. Ong, "Tangent Spaces and Diamond Encoding", 2023. The perpendicular is that of T. Duff et al.,
//! 2017.
//!
//! Error: 2^15 steps make a full turn, a length of 4 on the diamond. A step turns the direction by at most
//! twice its length, because the sides of the diamond are 1 / sqrt(2) from its centre. Rounding moves it by
//! half a step: 4 / 2^15 radians.

use crate::math::{add, dot, perpendiculars, scale};

const STEPS_OF_SIDE: f32 = 8192.0;

/// Encodes a tangent in two bytes: 15 bits of position, and a lowest bit that is set for w = -1. Error: up to
/// 0.0071 degrees.
///
/// `normal`: unit, with the same bits that the decoder gets. Pass the decoded normal where normals are
/// encoded as well. The component of the tangent along the normal is lost.
pub fn tangent_to_diamond(normal: [f32; 3], [x, y, z, w]: [f32; 4]) -> u16 {
    let [first, second] = perpendiculars(normal);
    let tangent = [x, y, z];
    let [x, y] = [dot(tangent, first), dot(tangent, second)];
    let size = x.abs() + y.abs();
    let place = if y < 0.0 { 3.0 + x / size } else { 1.0 - x / size };
    let step = (place * STEPS_OF_SIDE).round() as u16 & 0x7fff;
    step << 1 | u16::from(w < 0.0)
}

/// Decodes the unit tangent of [`tangent_to_diamond`].
///
/// `normal`: unit, with the same bits that the encoder got.
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

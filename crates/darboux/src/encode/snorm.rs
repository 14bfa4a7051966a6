//! Signed normalized integers: code c decodes to max(c / largest, -1), as in OpenGL 4.2, Vulkan, Direct3D 10,
//! WebGPU and glTF.
//!
//! Rounding moves each component by up to half a step, so the error of a direction is up to asin(sqrt(3) / (2
//! largest)). Decoded vectors are not normalised.

use crate::math::sign;

/// Encodes a tangent in four bytes. Error: up to 0.40 degrees.
pub fn tangent_to_snorm8([x, y, z, w]: [f32; 4]) -> [i8; 4] {
    [x, y, z, sign(w)].map(|component| steps(component, 127.0) as i8)
}

/// Decodes the tangent of [`tangent_to_snorm8`], as a vertex fetch does: not normalised.
pub fn tangent_from_snorm8(code: [i8; 4]) -> [f32; 4] {
    code.map(|component| value(component.into(), 127.0))
}

/// Encodes a tangent in eight bytes. Error: up to 0.0016 degrees.
pub fn tangent_to_snorm16([x, y, z, w]: [f32; 4]) -> [i16; 4] {
    [x, y, z, sign(w)].map(|component| steps(component, 32767.0) as i16)
}

/// Decodes the tangent of [`tangent_to_snorm16`], as a vertex fetch does: not normalised.
pub fn tangent_from_snorm16(code: [i16; 4]) -> [f32; 4] {
    code.map(|component| value(component.into(), 32767.0))
}

/// Encodes a tangent in four bytes: ten bits each of x (lowest), y and z, and two bits of w.
/// VK_FORMAT_A2B10G10R10_SNORM_PACK32, GL_INT_2_10_10_10_REV. Error: up to 0.098 degrees.
pub fn tangent_to_snorm10([x, y, z, w]: [f32; 4]) -> u32 {
    let [x, y, z] = [x, y, z].map(|component| steps(component, 511.0) as u32 & 0x3ff);
    let w = sign(w) as i32 as u32 & 3;
    x | y << 10 | z << 20 | w << 30
}

/// Decodes the tangent of [`tangent_to_snorm10`], as a vertex fetch does: not normalised.
pub fn tangent_from_snorm10(code: u32) -> [f32; 4] {
    let [x, y, z] = [22, 12, 2].map(|shift| value((code << shift) as i32 >> 22, 511.0));
    [x, y, z, value(code as i32 >> 30, 1.0)]
}

/// The nearest code, ties away from zero. Zero for NaN.
fn steps(component: f32, largest: f32) -> i32 {
    (component.clamp(-1.0, 1.0) * largest).round() as i32
}

fn value(code: i32, largest: f32) -> f32 {
    (code as f32 / largest).max(-1.0)
}

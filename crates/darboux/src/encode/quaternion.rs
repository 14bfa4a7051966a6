//! A whole frame as the rotation that turns x, y and z into tangent, cross(normal, tangent) and normal, the sign of w in the sign of
//! the quaternion: q and -q are one rotation. Its last component must not be zero, since integers have no -0.
//!
//! Source: I. Frey and I. Herzeg, "Spherical Skinning with Dual-Quaternions and QTangents", SIGGRAPH Talks 2011. They move the last
//! component away from zero before rounding; we round first, which moves it by at most one step. Quaternion of a matrix:
//! S. W. Shepperd, "Quaternion from Rotation Matrix", Journal of Guidance and Control 1(3), 1978.
//!
//! Error: three components round by half a step, the last by up to a whole one, and the rotation's angle is twice the quaternion's:
//! 2 sqrt(3/4 + 1) / 32767 radians.

use crate::math::{V3, cross, sign, unit_in_plane};

const LARGEST: f32 = 32767.0;

/// Eight bytes, x y z and the scalar last; either direction turns by up to 0.0047 degrees.
///
/// `normal`, `tangent`: unit; what of the tangent lies along the normal is lost.
pub fn frame_to_quaternion(normal: [f32; 3], [x, y, z, w]: [f32; 4]) -> [i16; 4] {
    let tangent = unit_in_plane(normal, [x, y, z]);
    let [x, y, z, scalar] = rotation([tangent, cross(normal, tangent), normal]);
    let factor = LARGEST * sign(scalar) * sign(w);
    let round = |component: f32| (component * factor).round() as i16;
    let nearest_to_zero = if w < 0.0 { -1 } else { 1 };
    let scalar = round(scalar);
    [round(x), round(y), round(z), if scalar == 0 { nearest_to_zero } else { scalar }]
}

/// The unit normal and the unit tangent of [`frame_to_quaternion`].
pub fn frame_from_quaternion(code: [i16; 4]) -> ([f32; 3], [f32; 4]) {
    let [x, y, z, w] = code.map(f32::from);
    let twice = 2.0 / (x * x + y * y + z * z + w * w);
    let normal = [twice * (x * z + w * y), twice * (y * z - w * x), 1.0 - twice * (x * x + y * y)];
    let tangent = [1.0 - twice * (y * y + z * z), twice * (x * y + w * z), twice * (x * z - w * y)];
    (normal, [tangent[0], tangent[1], tangent[2], sign(w)])
}

/// The unit quaternion, scalar last, of the rotation with these columns. Its largest component is found first, so that nothing cancels.
fn rotation([[m00, m10, m20], [m01, m11, m21], [m02, m12, m22]]: [V3; 3]) -> [f32; 4] {
    let four_squares =
        [1.0 + m00 - m11 - m22, 1.0 - m00 + m11 - m22, 1.0 - m00 - m11 + m22, 1.0 + m00 + m11 + m22];
    let [xx, yy, zz, ww] = four_squares;
    let largest = xx.max(yy).max(zz).max(ww);
    let four_products = if largest == ww {
        [m21 - m12, m02 - m20, m10 - m01, ww]
    } else if largest == xx {
        [xx, m10 + m01, m02 + m20, m21 - m12]
    } else if largest == yy {
        [m10 + m01, yy, m21 + m12, m02 - m20]
    } else {
        [m02 + m20, m21 + m12, zz, m10 - m01]
    };
    four_products.map(|product| product / (2.0 * largest.sqrt()))
}

//! Quaternion encoding of a frame: the rotation that maps x, y and z to tangent, cross(normal, tangent) and
//! normal.
//!
//! q and -q are the same rotation, so the sign of the scalar component stores the sign w. The scalar
//! component must not be zero, because integers have no -0.
//!
//! Source: I. Frey and I. Herzeg, "Spherical Skinning with Dual-Quaternions and QTangents", SIGGRAPH Talks
//! 2011. We deviate: they move the scalar component away from zero before rounding; we round first, which
//! moves it by at most one step. Quaternion of a matrix: S. W. Shepperd, "Quaternion from Rotation Matrix",
//! Journal of Guidance and Control 1(3), 1978.
//!
//! Error: three components are rounded by up to half a step, the scalar by up to one step, and the angle of
//! the rotation is twice that of the quaternion: 2 sqrt(3/4 + 1) / 32767 radians.

use crate::math::{V3, cross, sign, unit_in_plane};

const LARGEST: f32 = 32767.0;

/// Encodes a frame in eight bytes: x, y, z and the scalar component. Error of either direction: up to 0.0047
/// degrees.
///
/// `normal`, `tangent`: unit. The component of the tangent along the normal is lost.
pub fn frame_to_quaternion(normal: [f32; 3], [x, y, z, w]: [f32; 4]) -> [i16; 4] {
    let tangent = unit_in_plane(normal, [x, y, z]);
    let [x, y, z, scalar] = rotation([tangent, cross(normal, tangent), normal]);
    let factor = LARGEST * sign(scalar) * sign(w);
    let round = |component: f32| (component * factor).round() as i16;
    let nearest_to_zero = if w < 0.0 { -1 } else { 1 };
    let scalar = round(scalar);
    [round(x), round(y), round(z), if scalar == 0 { nearest_to_zero } else { scalar }]
}

/// Decodes the unit normal and the unit tangent of [`frame_to_quaternion`].
pub fn frame_from_quaternion(code: [i16; 4]) -> ([f32; 3], [f32; 4]) {
    let [x, y, z, w] = code.map(f32::from);
    let twice = 2.0 / (x * x + y * y + z * z + w * w);
    let normal = [twice * (x * z + w * y), twice * (y * z - w * x), 1.0 - twice * (x * x + y * y)];
    let tangent = [1.0 - twice * (y * y + z * z), twice * (x * y + w * z), twice * (x * z - w * y)];
    (normal, [tangent[0], tangent[1], tangent[2], sign(w)])
}

/// The unit quaternion (scalar last) of the rotation with these columns. The largest component is computed
/// first, so that no digits cancel.
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

//! Octahedral encoding: directions as points of a square. The sphere is projected to an octahedron, whose
//! lower half is folded outwards.
//!
//! Source: Q. Meyer et al., "On Floating-Point Normal Vectors", EGSR 2010; Z. Cigolle et al., "A Survey of
//! Efficient Representations for Independent Unit Vectors", JCGT 3(2), 2014. We round to the nearest point
//! and do not search its neighbours. Decoding is exact in integers until the vector is normalised, so that
//! the sign of z is the same on every machine.
//!
//! Error: steps of h and k along x and y move the point on the octahedron by up to (h, k, h + k) / 2, at a
//! radius of at least 1 / sqrt(3).

use crate::math::{V3, dot, scale, sign};

/// The largest code of normals in x and y.
const NORMAL_GRID: f32 = 32767.0;
/// The largest code of tangents in x. In y, tangents use every second code.
const TANGENT_GRID: f32 = 32766.0;

/// Encodes a normal in four bytes. Error: up to 0.0038 degrees.
pub fn normal_to_octahedral(normal: [f32; 3]) -> [i16; 2] {
    project(normal).map(|component| (component * NORMAL_GRID).round() as i16)
}

/// Decodes the unit normal of [`normal_to_octahedral`].
pub fn normal_from_octahedral(code: [i16; 2]) -> [f32; 3] {
    let [x, y] = code.map(f32::from);
    unfold(x, y, NORMAL_GRID)
}

/// Encodes a tangent in four bytes: 16 bits of x; 15 bits of y, and a lowest bit that is set for w = -1.
/// Error: up to 0.0057 degrees.
pub fn tangent_to_octahedral([x, y, z, w]: [f32; 4]) -> [i16; 2] {
    let [x, y] = project([x, y, z]);
    let half = (y * (TANGENT_GRID / 2.0)).round() as i16;
    [(x * TANGENT_GRID).round() as i16, half << 1 | i16::from(w < 0.0)]
}

/// Decodes the unit tangent of [`tangent_to_octahedral`].
pub fn tangent_from_octahedral([x, y]: [i16; 2]) -> [f32; 4] {
    let [a, b, c] = unfold(f32::from(x), f32::from(y & !1), TANGENT_GRID);
    [a, b, c, if y & 1 == 0 { 1.0 } else { -1.0 }]
}

/// The point of the square [-1, 1]^2 of a direction. NaN for zero, which integer conversion turns into 0.
fn project(v: V3) -> [f32; 2] {
    let size = v[0].abs() + v[1].abs() + v[2].abs();
    let [x, y] = [v[0] / size, v[1] / size];
    if v[2] < 0.0 { fold(x, y, 1.0) } else { [x, y] }
}

/// The unit vector of the point (x, y) of the square [-grid, grid]^2.
fn unfold(x: f32, y: f32, grid: f32) -> V3 {
    let z = grid - x.abs() - y.abs();
    let [x, y] = if z < 0.0 { fold(x, y, grid) } else { [x, y] };
    let v = [x, y, z];
    scale(1.0 / dot(v, v).sqrt(), v)
}

/// Mirrors a triangle of the square at its diagonal. Its own inverse.
fn fold(x: f32, y: f32, grid: f32) -> [f32; 2] {
    [(grid - y.abs()) * sign(x), (grid - x.abs()) * sign(y)]
}

//! Vectors in double precision.

pub use darboux::internal::vectors::double::{D3 as Vector, add_scaled, cross, dot, length, sub, unit};

/// A place in an image, in texels.
pub type Place = [f64; 2];

pub fn wide(v: [f32; 3]) -> Vector {
    v.map(f64::from)
}

pub fn narrow(v: Vector) -> [f32; 3] {
    v.map(|x| x as f32)
}

pub fn scale(factor: f64, v: Vector) -> Vector {
    v.map(|x| factor * x)
}

/// The sum of three vectors with weights: a value at a point of a triangle from those at its corners.
pub fn weighted<const N: usize>(weights: [f64; 3], corners: [[f32; N]; 3]) -> [f64; N] {
    mixture(weights, corners.map(|corner| corner.map(f64::from)))
}

/// As [`weighted`], of doubles.
pub fn mixture<const N: usize>(weights: [f64; 3], [a, b, c]: [[f64; N]; 3]) -> [f64; N] {
    std::array::from_fn(|i| weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i])
}

/// The diagonal of the box around positions. Coordinates that are not finite do not count; without any, it is
/// 0.
pub fn box_diagonal(positions: impl Iterator<Item = [f32; 3]>) -> f64 {
    length(box_extents(positions))
}

/// The extents of the box around positions along the axes. Coordinates that are not finite do not count;
/// without any, they are 0.
pub fn box_extents(positions: impl Iterator<Item = [f32; 3]>) -> Vector {
    let [low, high] = box_corners(positions);
    sub(high, low)
}

/// The low and the high corner of the box around positions. Coordinates that are not finite do not count;
/// without any along an axis, both are 0 there.
pub fn box_corners(positions: impl Iterator<Item = [f32; 3]>) -> [Vector; 2] {
    let empty = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    let [low, high] = positions.fold(empty, |[mut low, mut high], position| {
        for (axis, x) in wide(position).into_iter().enumerate().filter(|(_, x)| x.is_finite()) {
            low[axis] = low[axis].min(x);
            high[axis] = high[axis].max(x);
        }
        [low, high]
    });
    let filled =
        |corner: Vector| [0, 1, 2].map(|axis| if low[axis] <= high[axis] { corner[axis] } else { 0.0 });
    [filled(low), filled(high)]
}

/// Two unit vectors that with the unit `normal` make a right-handed frame (T. Duff et al., "Building an
/// Orthonormal Basis, Revisited", JCGT 6(1), 2017, listing 3).
pub fn perpendiculars([x, y, z]: Vector) -> [Vector; 2] {
    let sign = 1f64.copysign(z);
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    [[1.0 + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]]
}

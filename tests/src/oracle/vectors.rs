//! Vectors of three f64 numbers.

use std::array::from_fn;

/// x, y and z.
pub type Vec3 = [f64; 3];

/// The sum of two vectors.
pub fn add(a: Vec3, b: Vec3) -> Vec3 {
    from_fn(|i| a[i] + b[i])
}

/// The difference of two vectors.
pub fn sub(a: Vec3, b: Vec3) -> Vec3 {
    from_fn(|i| a[i] - b[i])
}

/// `v` times `factor`.
pub fn scale(factor: f64, v: Vec3) -> Vec3 {
    v.map(|x| factor * x)
}

/// The dot product.
pub fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The Euclidean length.
pub fn length(v: Vec3) -> f64 {
    dot(v, v).sqrt()
}

/// `v` scaled to unit length; zero stays zero.
pub fn normalize(v: Vec3) -> Vec3 {
    if length(v) > 0.0 { scale(1.0 / length(v), v) } else { v }
}

/// `v` projected onto the plane of a unit normal.
pub fn flatten(v: Vec3, normal: Vec3) -> Vec3 {
    sub(v, scale(dot(normal, v), normal))
}

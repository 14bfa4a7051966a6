//! Vectors in double precision, for answers that are not the core's.

use crate::samples::floats;

/// A vector.
pub type D3 = [f64; 3];

/// The same numbers.
pub fn doubles<const N: usize>(v: [f32; N]) -> [f64; N] {
    v.map(f64::from)
}

/// The nearest floats.
pub fn singles<const N: usize>(v: [f64; N]) -> [f32; N] {
    v.map(|x| x as f32)
}

/// The dot product.
pub fn dot(a: D3, b: D3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
pub fn cross(a: D3, b: D3) -> D3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The length.
pub fn length(v: D3) -> f64 {
    dot(v, v).sqrt()
}

/// `s` times `v`.
pub fn scale(s: f64, v: D3) -> D3 {
    v.map(|x| s * x)
}

/// The vector along `v` of length 1.
pub fn unit(v: D3) -> D3 {
    scale(1.0 / length(v), v)
}

/// Three vectors from nine words of a sample.
pub fn columns(sample: &[u32], start: usize) -> [D3; 3] {
    [0, 3, 6].map(|k| doubles(floats(sample, start + k)))
}

/// The columns' sum, weighted by the components of `v`: a matrix times a vector.
pub fn product(columns: [D3; 3], v: D3) -> D3 {
    [0, 1, 2].map(|k| columns[0][k] * v[0] + columns[1][k] * v[1] + columns[2][k] * v[2])
}

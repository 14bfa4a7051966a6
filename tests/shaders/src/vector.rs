//! Vectors in double precision, for expected results that the core does not compute.

/// A vector.
pub type D3 = [f64; 3];

/// Converts floats to double precision.
pub fn doubles<const N: usize>(v: [f32; N]) -> [f64; N] {
    v.map(f64::from)
}

/// Rounds to floats.
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

/// The unit vector along `v`.
pub fn unit(v: D3) -> D3 {
    scale(1.0 / length(v), v)
}

/// The product of a matrix, given by its columns, and a vector.
pub fn product(columns: [D3; 3], v: D3) -> D3 {
    [0, 1, 2].map(|k| columns[0][k] * v[0] + columns[1][k] * v[1] + columns[2][k] * v[2])
}

//! Vector functions in double precision. Nothing here may be re-associated or contracted.

/// Three doubles.
pub type D3 = [f64; 3];

/// a - b.
#[inline(always)]
pub fn sub(a: D3, b: D3) -> D3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The dot product.
#[inline(always)]
pub fn dot(a: D3, b: D3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
#[inline(always)]
pub fn cross(a: D3, b: D3) -> D3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The length.
#[inline(always)]
pub fn length(v: D3) -> f64 {
    dot(v, v).sqrt()
}

/// sum + weight * v.
#[inline(always)]
pub fn add_scaled(sum: D3, weight: f64, v: D3) -> D3 {
    [sum[0] + weight * v[0], sum[1] + weight * v[1], sum[2] + weight * v[2]]
}

/// `v`, normalised. `None` for zero and for vectors that are not finite. Squares of `f32` values neither
/// overflow nor underflow in `f64`.
#[inline]
pub fn unit(v: D3) -> Option<D3> {
    let length = length(v);
    (length > 0.0 && length.is_finite()).then(|| v.map(|x| x / length))
}

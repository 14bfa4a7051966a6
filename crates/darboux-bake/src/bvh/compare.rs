//! The lesser and the greater of two numbers by one instruction each: without the rule of `f32::min` and
//! `f32::max` for NaN.

/// `b` if one of them is a NaN.
#[inline(always)]
pub fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// `b` if one of them is a NaN.
#[inline(always)]
pub fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

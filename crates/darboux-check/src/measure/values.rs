//! What single vectors tell, and how far they may be off; the median of numbers.

use std::collections::HashMap;

use crate::surface::{length, xyz};

/// How far lengths of normals and of tangents may be from 1: 8-bit vectors are up to 0.007 off.
pub const UNIT: f64 = 0.02;

/// How far the size of a sign w may be from 1.
pub const SIGN: f32 = 0.01;

/// A smaller w is no sign: there is a rule about such values.
pub const MIN_SIGN: f32 = 0.1;

/// Whether all components are numbers.
pub fn is_finite<const N: usize>(vector: [f32; N]) -> bool {
    vector.iter().all(|x| x.is_finite())
}

/// Per vector the number of the first one that equals it.
pub fn first_equal<const N: usize>(vectors: &[[f32; N]]) -> Vec<u32> {
    let mut first = HashMap::with_capacity(vectors.len());
    // Adding 0.0 makes both zeros one.
    let key = |vector: &[f32; N]| vector.map(|x| (x + 0.0).to_bits());
    (0u32..).zip(vectors).map(|(number, vector)| *first.entry(key(vector)).or_insert(number)).collect()
}

/// Whether a tangent has a direction.
pub fn has_length(tangent: [f32; 4]) -> bool {
    is_finite(tangent) && length(xyz(tangent)) > 0.1
}

/// Whether a vector has length 1, up to rounding.
pub fn is_unit(vector: [f32; 3]) -> bool {
    (length(vector) - 1.0).abs() <= UNIT
}

/// Whether the size of a sign w is 1, up to rounding.
pub fn is_sign(w: f32) -> bool {
    (w.abs() - 1.0).abs() <= SIGN
}

/// The median, which is the upper one of the two in the middle of an even number. The order of the values
/// changes.
///
/// # Panics
/// Without values.
pub fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

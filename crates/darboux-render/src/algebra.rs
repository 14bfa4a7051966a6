//! 4 x 4 matrices, and the vector functions of the core.

pub use darboux::internal::vectors::single::{V3, cross, dot};

/// A matrix for column vectors, as an array of columns.
pub type Matrix = [[f64; 4]; 4];

pub const IDENTITY: Matrix =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// The first three columns of the matrix, without the last row. They are scaled by their largest element, so
/// that they fit floats.
pub fn direction_columns(matrix: &Matrix) -> [[f32; 3]; 3] {
    let largest = matrix[..3].as_flattened().iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let scale = if largest > 0.0 && largest.is_finite() { 1.0 / largest } else { 1.0 };
    [0, 1, 2].map(|i| [0, 1, 2].map(|k| (matrix[i][k] * scale) as f32))
}

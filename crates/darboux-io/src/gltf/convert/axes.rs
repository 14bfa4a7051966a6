//! A change of axes, applied to vectors, rotations, scales and matrices in single precision (accessors) or
//! double precision (JSON).

use std::ops::{Add, Mul};

use darboux::Convention;

/// The old axis and the sign of every new axis, and whether the handedness changes.
#[derive(Clone, Copy, Debug)]
pub struct AxisChange {
    axes: [(usize, f64); 3],
    changes_handedness: bool,
}

/// A floating-point type: `f32` for accessors, `f64` for JSON.
pub trait Number: Copy + From<f32> + Mul<Output = Self> + Add<Output = Self> {}

impl Number for f32 {}
impl Number for f64 {}

impl AxisChange {
    pub fn new(from: Convention, to: Convention) -> Self {
        // The converted axis numbers tell the source of every axis.
        let axes =
            from.to(to).vector([1.0, 2.0, 3.0]).map(|axis| (axis.abs() as usize - 1, axis.signum().into()));
        Self { axes, changes_handedness: from.axes.handedness() != to.axes.handedness() }
    }

    /// Converts a translation.
    pub fn vector<N: Number>(&self, vector: [N; 3]) -> [N; 3] {
        self.axes.map(|(axis, sign)| signed(sign, vector[axis]))
    }

    /// Converts scale factors along the axes.
    pub fn scale<N: Number>(&self, scale: [N; 3]) -> [N; 3] {
        self.axes.map(|(axis, _)| scale[axis])
    }

    /// Converts a unit quaternion, w last. Its axis is converted as a vector, and the angle is negated if the
    /// handedness changes.
    pub fn rotation<N: Number>(&self, [x, y, z, w]: [N; 4]) -> [N; 4] {
        let hand = if self.changes_handedness { -1.0 } else { 1.0 };
        let [x, y, z] = self.vector([x, y, z]).map(|component| signed(hand, component));
        [x, y, z, w]
    }

    /// Converts a matrix M of four columns: C M C^-1, where C is the change of axes.
    pub fn matrix<N: Number>(&self, matrix: [N; 16]) -> [N; 16] {
        let whole = |axis: usize| self.axes.get(axis).copied().unwrap_or((3, 1.0));
        std::array::from_fn(|at| {
            let ((column, column_sign), (row, row_sign)) = (whole(at / 4), whole(at % 4));
            signed(column_sign * row_sign, matrix[4 * column + row])
        })
    }
}

/// Multiplies by a sign, exactly, and turns -0 into 0 for the JSON.
fn signed<N: Number>(sign: f64, number: N) -> N {
    N::from(sign as f32) * number + N::from(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Column by column: M v.
    fn product(m: [f64; 16], v: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|row| (0..3).map(|k| m[4 * k + row] * v[k]).sum::<f64>() + m[12 + row])
    }

    #[test]
    fn converted_transforms_map_converted_vectors_to_converted_vectors() {
        // A quarter turn about z, then a move; as a matrix and as a quaternion.
        let matrix = [0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 4.0, 5.0, 6.0, 1.0];
        let (half, point) = (0.5f64.sqrt(), [1.0, 2.0, 3.0]);
        let rotate = |[x, y, z, w]: [f64; 4], v: [f64; 3]| {
            let q = [x, y, z];
            let cross = |a: [f64; 3], b: [f64; 3]| {
                [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
            };
            let inner = cross(q, v);
            let outer = cross(q, [0, 1, 2].map(|i| inner[i] + w * v[i]));
            [0, 1, 2].map(|i| v[i] + 2.0 * outer[i])
        };
        for (name, to) in Convention::PRESETS {
            let turn = AxisChange::new(Convention::GLTF, to);
            let moved = product(turn.matrix(matrix), turn.vector(point));
            assert_eq!(moved, turn.vector(product(matrix, point)), "{name}");
            let rotation = [0.0, 0.0, half, half];
            let rotated = rotate(turn.rotation(rotation), turn.vector(point));
            let expected = turn.vector(rotate(rotation, point));
            assert!((0..3).all(|i| (rotated[i] - expected[i]).abs() < 1e-12), "{name}");
            let scaled = turn.scale([2.0, 3.0, 5.0]);
            let direct: [f64; 3] = std::array::from_fn(|i| turn.vector(point)[i] * scaled[i]);
            assert_eq!(direct, turn.vector([2.0, 6.0, 15.0]), "{name}");
        }
    }
}

//! The discrete Fourier transform of a square block, on separate arrays of real and imaginary parts (Cooley
//! and Tukey 1965, radix 2).
//!
//! A stage combines whole rows, so that the inner loops run along contiguous values. Columns are transformed,
//! then the block is transposed, and its columns are transformed again: the result is left transposed.

/// The transform of blocks of `side` x `side` values, a power of two.
#[derive(Debug)]
pub struct Fourier {
    side: usize,
    /// The real and imaginary parts of exp(-2 pi i k / side), for k below half of the side.
    roots: Vec<[f32; 2]>,
    /// The row that each row is exchanged with before the first stage.
    reversed: Vec<usize>,
}

impl Fourier {
    pub fn new(side: usize) -> Self {
        let root = |k: usize| {
            let angle = -2.0 * std::f64::consts::PI * k as f64 / side as f64;
            [angle.cos() as f32, angle.sin() as f32]
        };
        let bits = side.trailing_zeros();
        let reverse = |row: usize| if bits == 0 { 0 } else { row.reverse_bits() >> (usize::BITS - bits) };
        Self { side, roots: (0..side / 2).map(root).collect(), reversed: (0..side).map(reverse).collect() }
    }

    /// Transforms a block in place. The value of the frequencies x and y is at index `x * side + y`.
    #[inline(always)]
    pub fn transform(&self, real: &mut [f32], imaginary: &mut [f32]) {
        self.transform_columns(real, imaginary);
        self.transpose(real);
        self.transpose(imaginary);
        self.transform_columns(real, imaginary);
    }

    #[inline(always)]
    fn transform_columns(&self, real: &mut [f32], imaginary: &mut [f32]) {
        let side = self.side;
        for values in [&mut *real, &mut *imaginary] {
            for (row, &other) in self.reversed.iter().enumerate().filter(|(row, other)| row < other) {
                let (upper, lower) = values.split_at_mut(other * side);
                upper[row * side..][..side].swap_with_slice(&mut lower[..side]);
            }
        }
        let mut half = 1;
        while half < side {
            for start in (0..side).step_by(2 * half) {
                for k in 0..half {
                    let root = self.roots[k * (side / 2 / half)];
                    butterfly(
                        real,
                        imaginary,
                        [start + k, start + k + half].map(|row| row * side),
                        side,
                        root,
                    );
                }
            }
            half *= 2;
        }
    }

    #[inline(always)]
    fn transpose(&self, values: &mut [f32]) {
        for row in 0..self.side {
            for column in 0..row {
                values.swap(row * self.side + column, column * self.side + row);
            }
        }
    }
}

/// Replaces two rows a and b by a + root b and a - root b.
#[inline(always)]
fn butterfly(
    real: &mut [f32],
    imaginary: &mut [f32],
    [first, second]: [usize; 2],
    side: usize,
    [cos, sin]: [f32; 2],
) {
    let (upper, lower) = real.split_at_mut(second);
    let (real_a, real_b) = (&mut upper[first..][..side], &mut lower[..side]);
    let (upper, lower) = imaginary.split_at_mut(second);
    let (imaginary_a, imaginary_b) = (&mut upper[first..][..side], &mut lower[..side]);
    for i in 0..side {
        let turned_real = real_b[i] * cos - imaginary_b[i] * sin;
        let turned_imaginary = real_b[i] * sin + imaginary_b[i] * cos;
        real_b[i] = real_a[i] - turned_real;
        imaginary_b[i] = imaginary_a[i] - turned_imaginary;
        real_a[i] += turned_real;
        imaginary_a[i] += turned_imaginary;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every frequency agrees with the sum that defines it.
    #[test]
    fn transform_is_the_sum_over_all_values() {
        let side = 8;
        let value = |i: usize| [((i * 37 + 11) % 64) as f32 / 64.0, ((i * 23 + 5) % 64) as f32 / 64.0];
        let values: Vec<[f32; 2]> = (0..side * side).map(value).collect();
        let mut real: Vec<f32> = values.iter().map(|value| value[0]).collect();
        let mut imaginary: Vec<f32> = values.iter().map(|value| value[1]).collect();
        Fourier::new(side).transform(&mut real, &mut imaginary);
        for (u, v) in (0..side).flat_map(|u| (0..side).map(move |v| (u, v))) {
            let mut sum = [0.0f64; 2];
            for (i, [a, b]) in values.iter().map(|value| value.map(f64::from)).enumerate() {
                let turns = (u * (i % side) + v * (i / side)) as f64 / side as f64;
                let (sin, cos) = (-2.0 * std::f64::consts::PI * turns).sin_cos();
                sum = [sum[0] + a * cos - b * sin, sum[1] + a * sin + b * cos];
            }
            let found = [real[u * side + v], imaginary[u * side + v]].map(f64::from);
            assert!((0..2).all(|i| (found[i] - sum[i]).abs() < 1e-4), "{u}, {v}: {found:?}, {sum:?}");
        }
    }
}

//! The second witness: the share of slope energy that no height field explains.
//!
//! Among all height fields, the one whose slopes are nearest to p and q in the sense of least squares solves
//! a Poisson equation. In the Fourier domain its residual at the frequency k = (k_u, k_v) is |k_v P - k_u
//! Q|^2 / |k|^2 (Frankot and Chellappa 1988). With green inverted, Q changes its sign. So one cross-spectrum
//! gives both residuals: they differ by four times the sum of k_u k_v / |k|^2 Re(P conj(Q)).
//!
//! That sum is also the value at shift zero of a function of the shift of q against p, whose mean square over
//! all cyclic shifts is the sum of the squared terms (Parseval). A map is compared with all its own shifts in
//! this way: the shift score is the value over the root of that mean. Patterns that repeat inside of a block,
//! or from block to block, repeat in that function as well, and do not count as independent.
//!
//! Blocks of at most 64 x 64 texels of every halving are transformed, with a window against the steps at
//! their ends. A large map is sampled: of the rows of blocks, the first eight count, then every second,
//! fourth and so on, with weights.

use std::ops::Range;

use super::fourier::Fourier;

/// Sums that are added side by side; a divisor of the texels of all blocks.
const LANES: usize = 16;

/// The largest side of a block.
const MAX_SIDE: usize = 64;

/// The smallest side of a block.
const MIN_SIDE: usize = 16;

/// The most blocks in a row of blocks.
const MAX_COLUMNS: usize = 6;

/// Rows of blocks that all count.
const ALL_BANDS: usize = 8;

/// What the overlap of shifted windows takes from the root of the mean square, for Hann's window: its fourth
/// power has the mean 35/128, and the square of its square's mean is 9/64, per axis.
const WINDOW_FACTOR: f64 = 35.0 / 18.0;

/// Sums over blocks of one level.
#[derive(Debug)]
pub struct Spectrum {
    side: usize,
    fourier: Fourier,
    window: Vec<f32>,
    /// The first columns of the blocks.
    starts: Vec<usize>,
    /// The x and y of the rows of blocks that is being filled, block after block.
    band: [Vec<f32>; 2],
    /// The rows pushed.
    rows: usize,
    /// The weights of all blocks.
    blocks: f64,
    /// Per frequency, P conj(Q) and the squares of P and Q; row after row of v, the first half of u.
    cross: [Vec<f32>; 2],
    squares: [Vec<f32>; 2],
}

/// What the frequencies of one octave say. All sums are means over blocks, in units of the squared slope of a
/// texel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Octave {
    /// The energy of p and q.
    pub energy: f64,
    /// The part of it that no height field explains, without regard to the sign of green: the mean of both
    /// residuals.
    pub residual: f64,
    /// Half the difference of the residuals, DirectX less OpenGL.
    pub difference: f64,
    /// The mean square of `difference` over all shifts.
    pub shifted: f64,
}

impl Spectrum {
    /// None for maps that are too small.
    pub fn new(width: usize) -> Option<Self> {
        let side = [MAX_SIDE, MAX_SIDE / 2, MIN_SIDE].into_iter().find(|&side| side <= width)?;
        let columns = (width / side).min(MAX_COLUMNS);
        let starts = (0..columns).map(|i| (width - side) * i / (columns - 1).max(1)).collect();
        let angle = |i: usize| 2.0 * std::f64::consts::PI * (i as f64 + 0.5) / side as f64;
        let frequencies = || vec![0.0; side * (side / 2 + 1)];
        Some(Self {
            side,
            fourier: Fourier::new(side),
            window: (0..side).map(|i| (0.5 - 0.5 * angle(i).cos()) as f32).collect(),
            starts,
            band: [const { Vec::new() }; 2],
            rows: 0,
            blocks: 0.0,
            cross: [frequencies(), frequencies()],
            squares: [frequencies(), frequencies()],
        })
    }

    /// Whether there is a block.
    pub fn has_blocks(&self) -> bool {
        self.blocks > 0.0
    }

    pub fn side(&self) -> usize {
        self.side
    }

    #[inline(always)]
    pub fn push_row(&mut self, x: &[f32], y: &[f32]) {
        let (band, row) = (self.rows / self.side, self.rows % self.side);
        self.rows += 1;
        let stride = (band * 2 / ALL_BANDS).max(1);
        let stride = 1 << stride.ilog2();
        if !band.is_multiple_of(stride) {
            return;
        }
        let area = self.side * self.side;
        for (out, values) in self.band.iter_mut().zip([x, y]) {
            out.resize(area * self.starts.len(), 0.0);
            for (index, &start) in self.starts.iter().enumerate() {
                out[index * area + row * self.side..][..self.side]
                    .copy_from_slice(&values[start..][..self.side]);
            }
        }
        if row + 1 == self.side {
            let [mut x, mut y] = std::mem::take(&mut self.band);
            for (x, y) in x.chunks_exact_mut(area).zip(y.chunks_exact_mut(area)) {
                self.add_block(x, y, stride as f32);
            }
            self.band = [x, y];
        }
    }

    #[inline(always)]
    fn add_block(&mut self, x: &mut [f32], y: &mut [f32], weight: f32) {
        if !(self.prepare(x) && self.prepare(y)) {
            return;
        }
        self.fourier.transform(x, y);
        self.blocks += f64::from(weight);
        self.add_frequencies(x, y, weight);
    }

    /// Subtracts the mean, replaces texels that are no vectors by it, and applies the window. False where
    /// most texels are none.
    #[inline(always)]
    fn prepare(&self, values: &mut [f32]) -> bool {
        let (mut sums, mut counts) = ([0.0; LANES], [0.0; LANES]);
        for lanes in values.as_chunks::<LANES>().0 {
            for i in 0..LANES {
                let is_valid = !lanes[i].is_nan();
                sums[i] += if is_valid { lanes[i] } else { 0.0 };
                counts[i] += if is_valid { 1.0 } else { 0.0 };
            }
        }
        let [sum, count] = [sums, counts].map(|lanes| lanes.iter().sum::<f32>());
        if 2.0 * count < values.len() as f32 {
            return false;
        }
        let mean = sum / count;
        for (row, across) in values.chunks_exact_mut(self.side).zip(&self.window) {
            for (value, along) in row.iter_mut().zip(&self.window) {
                *value = if value.is_nan() { 0.0 } else { (*value - mean) * across * along };
            }
        }
        true
    }

    /// Separates the transforms P and Q of x and y from that of x + i y, and adds their products.
    #[inline(always)]
    fn add_frequencies(&mut self, real: &[f32], imaginary: &[f32], weight: f32) {
        let side = self.side;
        for u in 0..=side / 2 {
            let (row, opposite) = (u * side, (side - u) % side * side);
            self.add_frequency_pairs(row..row + 1, [real, imaginary], opposite..opposite + 1, weight);
            let (row, opposite) = (row + 1..row + side, opposite + 1..opposite + side);
            self.add_frequency_pairs(row, [real, imaginary], opposite, weight);
        }
    }

    /// Adds the products of frequencies `here`, each with its opposite one, of which the last is first in
    /// `there`.
    #[inline(always)]
    fn add_frequency_pairs(
        &mut self,
        here: Range<usize>,
        [real, imaginary]: [&[f32]; 2],
        there: Range<usize>,
        weight: f32,
    ) {
        let ([cross_real, cross_imaginary], [p, q]) = (&mut self.cross, &mut self.squares);
        let count = here.len();
        let [a, b] = [real, imaginary].map(|values| &values[here.clone()][..count]);
        let [c, d] = [real, imaginary].map(|values| &values[there.clone()][..count]);
        let sums = [cross_real, cross_imaginary, p, q].map(|sums| &mut sums[here.clone()][..count]);
        let [cross_real, cross_imaginary, p, q] = sums;
        for i in 0..count {
            let (a, b, c, d) = (a[i], b[i], c[count - 1 - i], d[count - 1 - i]);
            cross_real[i] += weight * 0.5 * (a * d + b * c);
            cross_imaginary[i] += weight * 0.25 * (a * a - c * c + b * b - d * d);
            p[i] += weight * 0.25 * ((a + c) * (a + c) + (b - d) * (b - d));
            q[i] += weight * 0.25 * ((b + d) * (b + d) + (a - c) * (a - c));
        }
    }

    /// Sums the frequencies whose distance from zero, in cycles per block, is at least `from` and below
    /// `below`.
    pub fn octave(&self, from: f64, below: f64) -> Octave {
        let side = self.side;
        let mut octave = Octave::default();
        for (u, v) in (0..=side / 2).flat_map(|u| (0..side).map(move |v| (u, v))) {
            let [along, down] = [u, v].map(|k| if k > side / 2 { k as f64 - side as f64 } else { k as f64 });
            let squared = along * along + down * down;
            if squared < (from * from).max(0.5) || squared >= below * below {
                continue;
            }
            // The frequencies of the other half of u have the same values, conjugated. Those of the ends have
            // no counterpart.
            let count = if u == 0 || u == side / 2 { 1.0 } else { 2.0 };
            let at = u * side + v;
            let [real, imaginary] = [0, 1].map(|i| f64::from(self.cross[i][at]));
            let [p, q] = [0, 1].map(|i| f64::from(self.squares[i][at]));
            // Rows count downwards, v upwards.
            let factor = -2.0 * along * down / squared;
            octave.energy += count * (p + q);
            octave.residual += count * (down * down * p + along * along * q) / squared;
            octave.difference += count * factor * real;
            octave.shifted += count * factor * factor * (real * real + imaginary * imaginary);
        }
        octave.scaled(1.0 / (self.blocks.max(1.0) * self.energy_of_window()))
    }

    /// The energy of a block of slopes of 1: frequencies times squared windows.
    fn energy_of_window(&self) -> f64 {
        let squares = self.window.iter().map(|x| f64::from(x * x)).sum::<f64>();
        squares * squares * (self.side * self.side) as f64
    }
}

impl Octave {
    fn scaled(self, factor: f64) -> Self {
        Self {
            energy: factor * self.energy,
            residual: factor * self.residual,
            difference: factor * self.difference,
            shifted: factor * factor * self.shifted,
        }
    }

    pub fn add(&mut self, other: &Self) {
        self.energy += other.energy;
        self.residual += other.residual;
        self.difference += other.difference;
        self.shifted += other.shifted;
    }

    /// The share of the energy that no height field explains, of OpenGL's convention and of DirectX's.
    pub fn residuals(&self) -> [f64; 2] {
        [self.residual - self.difference, self.residual + self.difference]
            .map(|residual| if self.energy > 0.0 { (residual / self.energy).clamp(0.0, 1.0) } else { 0.5 })
    }

    /// The difference in units of its root mean square over all shifts. Shifted windows overlap less, which
    /// makes that mean smaller than it would be for unrelated slopes at the same place.
    pub fn shift_score(&self) -> f64 {
        if self.shifted > 0.0 { self.difference / (WINDOW_FACTOR * self.shifted.sqrt()) } else { 0.0 }
    }
}

//! One level of the pyramid: the map halved some number of times, with the correlation of every tile.

use super::spectrum::Spectrum;

/// Texels per side of a tile.
pub const TILE: usize = 16;

/// The largest difference of neighbouring texels that do not lie on both sides of a chart's border.
const MAX_STEP: f32 = 1.0;

/// The fewest texels of a tile that has a correlation.
const MIN_TEXELS: f32 = (TILE * TILE / 4) as f32;

/// The mean square of the difference of two codes of 8 bits that were rounded: twice the variance of
/// rounding.
const ROUNDING: f64 = 2.0 / 12.0 * (2.0 / 255.0) * (2.0 / 255.0);

/// The sums of a tile: dp/dv dq/du, the squares of dp/dv, dq/du, dp/du and dq/dv, and the number of texels.
const SUM_COUNT: usize = 6;

#[derive(Debug)]
pub struct Level {
    width: usize,
    /// The rows pushed.
    height: usize,
    /// The energy that rounding gives the derivative of a texel.
    rounding: f64,
    /// The last three rows of x and of y, in turn.
    x: [Vec<f32>; 3],
    y: [Vec<f32>; 3],
    /// The sums of every column over the rows of the current tiles.
    columns: [Vec<f32>; SUM_COUNT],
    /// A row of the next level.
    half: [Vec<f32>; 2],
    pub tile_sums: TileSums,
    /// None where the level is smaller than a block of the full size.
    pub spectrum: Option<Spectrum>,
    /// The correlation of every tile, row after row; NaN where it has none.
    pub correlations: Vec<f32>,
}

/// Sums over the tiles of a level.
#[derive(Clone, Copy, Debug, Default)]
pub struct TileSums {
    pub tiles: usize,
    pub correlations: f64,
    pub squared_correlations: f64,
    /// The sum of the tiles' weights, the energies of their mixed derivatives above that of rounding, and of
    /// the correlations times these.
    pub weights: f64,
    pub weighted_correlations: f64,
    /// Half the logarithm of the energy of the unmixed derivatives over that of the mixed ones.
    pub log_energy_ratios: f64,
    pub squared_log_energy_ratios: f64,
    /// The squares of all four derivatives, and the number of texels.
    pub energy: f64,
    pub texels: f64,
}

/// Replaces texels that are no vectors by NaN: x and y alone are longer than 1. Black and white backgrounds
/// are such texels.
#[inline(always)]
pub fn set_invalid_to_nan(x: &mut [f32], y: &mut [f32]) {
    for (x, y) in x.iter_mut().zip(y) {
        let is_vector = *x * *x + *y * *y <= 1.1;
        *x = if is_vector { *x } else { f32::NAN };
        *y = if is_vector { *y } else { f32::NAN };
    }
}

/// Pushes a row into the first level and, every second time, the mean of two rows into the next one.
#[inline(always)]
pub fn push(levels: &mut [Level], x: &[f32], y: &[f32]) {
    let Some((first, mut rest)) = levels.split_first_mut() else { return };
    first.push_row(x, y);
    let mut above = first;
    while above.height.is_multiple_of(2) {
        let Some((next, others)) = rest.split_first_mut() else { return };
        above.halve();
        next.push_row(&above.half[0], &above.half[1]);
        (above, rest) = (next, others);
    }
}

impl Level {
    /// `index`: the number of halvings. `block`: the side of the blocks of the full size.
    pub fn new(index: usize, width: usize, block: Option<usize>) -> Self {
        // Each halving takes the mean of four texels, whose roundings are independent.
        let rounding = ROUNDING / (1u64 << (2 * index).min(62)) as f64;
        let row = || vec![0.0; width];
        Self {
            width,
            height: 0,
            rounding,
            x: std::array::from_fn(|_| row()),
            y: std::array::from_fn(|_| row()),
            columns: std::array::from_fn(|_| row()),
            half: std::array::from_fn(|_| vec![0.0; width / 2]),
            tile_sums: TileSums::default(),
            spectrum: Spectrum::new(width).filter(|spectrum| Some(spectrum.side()) == block),
            correlations: Vec::new(),
        }
    }

    #[inline(always)]
    fn push_row(&mut self, x: &[f32], y: &[f32]) {
        let slot = self.height % 3;
        self.x[slot].copy_from_slice(&x[..self.width]);
        self.y[slot].copy_from_slice(&y[..self.width]);
        if let Some(spectrum) = &mut self.spectrum {
            spectrum.push_row(x, y);
        }
        self.height += 1;
        if self.height >= 3 {
            self.add_middle_row();
        }
        if self.height.is_multiple_of(TILE) {
            self.fold_tiles();
        }
    }

    /// Adds the products of the middle one of the last three rows to the columns.
    #[inline(always)]
    fn add_middle_row(&mut self) {
        let [above, middle, below] = [self.height, self.height + 1, self.height + 2].map(|row| row % 3);
        let length = self.width - 2;
        let inner = 1..=length;
        let (x_above, x_below) = (&self.x[above][inner.clone()], &self.x[below][inner.clone()]);
        let (y_above, y_below) = (&self.y[above][inner.clone()], &self.y[below][inner.clone()]);
        let (x_left, x_right) = (&self.x[middle][..length], &self.x[middle][2..][..length]);
        let (y_left, y_right) = (&self.y[middle][..length], &self.y[middle][2..][..length]);
        let [products, p_v, q_u, p_u, q_v, counts] =
            self.columns.each_mut().map(|column| &mut column[1..=length]);
        for i in 0..length {
            let (a, b) = (x_above[i] - x_below[i], y_right[i] - y_left[i]);
            let (c, d) = (x_right[i] - x_left[i], y_above[i] - y_below[i]);
            let is_smooth =
                (a.abs() <= MAX_STEP) & (b.abs() <= MAX_STEP) & (c.abs() <= MAX_STEP) & (d.abs() <= MAX_STEP);
            products[i] += if is_smooth { a * b } else { 0.0 };
            p_v[i] += if is_smooth { a * a } else { 0.0 };
            q_u[i] += if is_smooth { b * b } else { 0.0 };
            p_u[i] += if is_smooth { c * c } else { 0.0 };
            q_v[i] += if is_smooth { d * d } else { 0.0 };
            counts[i] += if is_smooth { 1.0 } else { 0.0 };
        }
    }

    /// Turns the columns into the sums of one row of tiles.
    #[inline(always)]
    fn fold_tiles(&mut self) {
        for tile in 0..self.width / TILE {
            let columns = tile * TILE..(tile + 1) * TILE;
            let sums = self.columns.each_ref().map(|sums| sums[columns.clone()].iter().sum::<f32>());
            let correlation = self.tile_sums.add(sums, self.rounding);
            self.correlations.push(correlation.map_or(f32::NAN, |correlation| correlation as f32));
        }
        self.columns.iter_mut().for_each(|sums| sums.fill(0.0));
    }

    /// The mean of the last two rows and of two texels each.
    #[inline(always)]
    fn halve(&mut self) {
        let [upper, lower] = [self.height + 1, self.height + 2].map(|row| row % 3);
        for (out, rows) in self.half.iter_mut().zip([&self.x, &self.y]) {
            let pairs = rows[upper].as_chunks::<2>().0.iter().zip(rows[lower].as_chunks::<2>().0);
            for (out, (a, b)) in out.iter_mut().zip(pairs) {
                *out = (a[0] + a[1] + b[0] + b[1]) * 0.25;
            }
        }
    }
}

impl TileSums {
    /// Adds a tile and returns its correlation; none where it has too few texels or no derivatives.
    /// `rounding`: the energy of a texel's derivative that rounding makes.
    fn add(&mut self, sums: [f32; SUM_COUNT], rounding: f64) -> Option<f64> {
        let [product, p_v, q_u, p_u, q_v, count] = sums;
        let [product, p_v, q_u, p_u, q_v] = [product, p_v, q_u, p_u, q_v].map(f64::from);
        let (mixed, unmixed) = (p_v * q_u, p_u * q_v);
        if count < MIN_TEXELS || !(mixed > 0.0) {
            return None;
        }
        let correlation = product / mixed.sqrt();
        self.tiles += 1;
        self.correlations += correlation;
        self.squared_correlations += correlation * correlation;
        let weight = (mixed.sqrt() - f64::from(count) * rounding).max(0.0);
        self.weights += weight;
        self.weighted_correlations += weight * correlation;
        // The floor stands for the rounding of texels.
        let log_energy_ratio = ((unmixed + 1e-9) / (mixed + 1e-9)).ln() / 2.0;
        self.log_energy_ratios += log_energy_ratio;
        self.squared_log_energy_ratios += log_energy_ratio * log_energy_ratio;
        self.energy += p_v + q_u + p_u + q_v;
        self.texels += f64::from(count);
        Some(correlation)
    }
}

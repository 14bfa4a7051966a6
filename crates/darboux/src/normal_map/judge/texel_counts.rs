//! Counts texels: background, lengths, signs of z, greys, and the commonest codes.

use super::judgement::{MapJudgement, MapVerdict};
use crate::normal_map::texels::{Channel, TexelLayout, can_be_normal};

/// Vectors that are summed side by side.
const LANES: usize = 16;

/// The greatest difference between a code of a flat map and its commonest code, for rounding and dither.
const FLAT_TOLERANCE: usize = 2;

/// All components of a black texel are smaller, and those of a white texel are larger than its negation.
const BLACK: f32 = -0.7;

/// The greatest difference between the z of a texel and that of the unit vector with its x and y, for
/// rounding: two codes of 8 bits.
const Z_TOLERANCE: f32 = 4.0 / 255.0;

/// The length of a middle grey texel is smaller.
const MAX_GREY_LENGTH: f32 = 0.12;

/// A texel whose x and y are beyond the unit circle by this much, in squared length, and whose z is zero but
/// for so much: where z was computed from two channels, black background becomes (-1, -1, 0).
const MIN_SQUARE_WITHOUT_Z: f32 = 1.3;
const MAX_Z_WITHOUT_Z: f32 = 0.1;

#[derive(Debug)]
pub struct TexelCounts {
    texels: usize,
    has_z: bool,
    kinds: KindCounts,
    vector_sums: VectorSums,
    z_range: [f32; 2],
    /// The number of texels of every 8-bit x (low byte) and y (high byte).
    codes: Vec<u32>,
}

/// Numbers of texels of each kind.
#[derive(Clone, Copy, Debug, Default)]
struct KindCounts {
    background: usize,
    not_unit: usize,
    negative_z: usize,
    grey: usize,
    not_normal: usize,
    wrong_z: usize,
}

/// Sums of x, y, z and lengths.
type VectorSums = [f64; 4];

impl TexelCounts {
    /// `has_z`: whether the texels store z.
    pub fn new(has_z: bool) -> Self {
        let z_range = [f32::INFINITY, f32::NEG_INFINITY];
        Self {
            texels: 0,
            has_z,
            kinds: KindCounts::default(),
            vector_sums: [0.0; 4],
            z_range,
            codes: vec![0; 1 << 16],
        }
    }

    /// Counts the codes of x and y.
    #[inline(always)]
    pub fn count_codes<C: Channel, const N: usize>(&mut self, texels: &[[C; N]], layout: TexelLayout<N>) {
        self.texels += texels.len();
        let code =
            |texel: &[C; N]| usize::from(texel[layout.x].byte()) | usize::from(texel[layout.y].byte()) << 8;
        // Runs of equal texels are counted at once: increments of one counter would wait for each other.
        let mut runs = texels.iter().map(code);
        let Some(mut last) = runs.next() else { return };
        let mut length = 1;
        for code in runs {
            if code == last {
                length += 1;
            } else {
                self.codes[last] = self.codes[last].saturating_add(length);
                (last, length) = (code, 1);
            }
        }
        self.codes[last] = self.codes[last].saturating_add(length);
    }

    /// Counts lengths, signs and greys of a row.
    #[inline(always)]
    pub fn count_vectors(&mut self, [x, y, z]: [&[f32]; 3]) {
        let has_z = self.has_z;
        let mut lanes = [[0.0f32; LANES]; 4];
        let mut counts = [[0u32; LANES]; 6];
        let mut range = [[f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]];
        let ((x, x_rest), (y, y_rest), (z, z_rest)) = (x.as_chunks(), y.as_chunks(), z.as_chunks());
        let rest = [x_rest, y_rest, z_rest].map(|values| {
            let mut lanes = [f32::NAN; LANES];
            lanes[..values.len()].copy_from_slice(values);
            lanes
        });
        let whole = x.iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]);
        for [x, y, z] in whole.chain([rest.each_ref()]) {
            for i in 0..LANES {
                let length = (x[i] * x[i] + y[i] * y[i] + z[i] * z[i]).sqrt();
                let differences = (x[i] - y[i]).abs().max((y[i] - z[i]).abs());
                let is_grey = has_z & (differences <= 3.5 * 2.0 / 255.0);
                // Compression blends the background with the texels beside it, so all nearly black, white and
                // middle grey texels belong to it.
                let third = if has_z { z[i] } else { x[i] };
                let (low, high) = (x[i].min(y[i]).min(third), x[i].max(y[i]).max(third));
                let is_without_z = has_z
                    & (x[i] * x[i] + y[i] * y[i] > MIN_SQUARE_WITHOUT_Z)
                    & (z[i].abs() < MAX_Z_WITHOUT_Z);
                let is_background =
                    (high < BLACK) | (low > -BLACK) | (length < MAX_GREY_LENGTH) | is_without_z;
                // NaN fills the last lanes.
                let counts_here = !is_background & (length >= 0.0);
                counts[0][i] += u32::from(is_background);
                counts[1][i] += u32::from(counts_here & !(0.9..=1.1).contains(&length));
                counts[2][i] += u32::from(counts_here & has_z & (z[i] < -0.01));
                counts[3][i] += u32::from(counts_here & is_grey);
                counts[4][i] += u32::from(counts_here & !can_be_normal(length, z[i]));
                let unit_z = (1.0 - x[i] * x[i] - y[i] * y[i]).max(0.0).sqrt();
                counts[5][i] += u32::from(counts_here & ((z[i] - unit_z).abs() > Z_TOLERANCE));
                for (lane, value) in lanes.iter_mut().zip([x[i], y[i], z[i], length]) {
                    lane[i] += if counts_here { value } else { 0.0 };
                }
                range[0][i] = range[0][i].min(if counts_here { z[i] } else { f32::INFINITY });
                range[1][i] = range[1][i].max(if counts_here { z[i] } else { f32::NEG_INFINITY });
            }
        }
        let [background, not_unit, negative_z, grey, not_normal, wrong_z] =
            counts.map(|lanes| lanes.iter().map(|&count| count as usize).sum::<usize>());
        self.kinds.background += background;
        self.kinds.not_unit += not_unit;
        self.kinds.negative_z += negative_z;
        self.kinds.grey += grey;
        self.kinds.not_normal += not_normal;
        self.kinds.wrong_z += wrong_z;
        for (sum, lanes) in self.vector_sums.iter_mut().zip(lanes) {
            *sum += lanes.iter().map(|&lane| f64::from(lane)).sum::<f64>();
        }
        self.z_range[0] = range[0].iter().copied().fold(self.z_range[0], f32::min);
        self.z_range[1] = range[1].iter().copied().fold(self.z_range[1], f32::max);
    }

    /// The commonest code among `x` and `y` of a range, and its number. The smallest one of several.
    fn commonest(&self, range: std::ops::RangeInclusive<usize>) -> ([u8; 2], usize) {
        let mut best = ([0, 0], 0);
        for y in range.clone() {
            let row = &self.codes[y << 8..][range.clone()];
            let most = row.iter().copied().max().unwrap_or(0);
            if most > best.1 {
                let x = row.iter().position(|&count| count == most).unwrap_or(0);
                best = ([(range.start() + x) as u8, y as u8], most);
            }
        }
        (best.0, best.1 as usize)
    }

    /// Whether x and y of all texels but a few are within [`FLAT_TOLERANCE`] codes of the commonest ones. A
    /// few: 1 % of the texels but at most 16, or 0.001 %, whichever is more. False for a map without
    /// texels.
    pub fn is_flat(&self) -> bool {
        let ([x, y], _) = self.commonest(0..=255);
        let around = |code: u8| {
            usize::from(code).saturating_sub(FLAT_TOLERANCE)..=(usize::from(code) + FLAT_TOLERANCE).min(255)
        };
        let near = around(y).flat_map(|y| around(x).map(move |x| self.codes[x | y << 8] as usize));
        let others = self.texels - near.sum::<usize>().min(self.texels);
        self.texels > 0 && others <= 16.min(self.texels / 100).max(self.texels / 100_000)
    }

    /// The counts, without a verdict.
    pub fn judgement(&self) -> MapJudgement {
        let vectors = (self.texels - self.kinds.background).max(1) as f64;
        let [x, y, z, length] = self.vector_sums.map(|sum| (sum / vectors) as f32);
        let (commonest, commonest_count) = self.commonest(0..=255);
        let (near_flat, near_flat_count) = self.commonest(120..=136);
        MapJudgement {
            verdict: MapVerdict::CannotTell,
            confidence: 0.5,
            correlation: 0.0,
            z_score: 0.0,
            relief_correlation: 0.0,
            shift_score: 0.0,
            residuals: [0.5; 2],
            has_opposed_detail: false,
            log_energy_ratio: 0.0,
            is_exchanged: false,
            texels: self.texels,
            background: self.kinds.background,
            not_unit: self.kinds.not_unit,
            negative_z: self.kinds.negative_z,
            grey: self.kinds.grey,
            not_normal: self.kinds.not_normal,
            has_z: self.has_z,
            wrong_z: self.kinds.wrong_z,
            mean_length: length,
            mean: [x, y, z],
            z_range: if self.z_range[0] <= self.z_range[1] { self.z_range } else { [0.0; 2] },
            commonest,
            commonest_count,
            near_flat: (near_flat_count > 0).then_some(near_flat),
        }
    }
}

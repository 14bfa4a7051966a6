//! [`ColorTexture`]: a texture of a material, filtered over the footprint of a texel.
//!
//! Texels are averaged in linear light: mip levels by boxes, between and within levels linearly, along the
//! longer side of the footprint by up to [`MOST_TAPS`] places, as GPUs filter anisotropically (L. Williams,
//! "Pyramidal Parametrics", 1983; EXT_texture_filter_anisotropic).

use std::sync::{Arc, LazyLock};

use darboux_io::gltf::Wrap;
use darboux_io::image::{RgbaCodes, srgb_to_linear};

use crate::BakeError;
use crate::texture_wrap::Mix;
use crate::vector::Place;

/// Red, green, blue and alpha.
pub type Color = [f64; 4];

/// The most places along the longer side of a footprint.
const MOST_TAPS: f64 = 8.0;

/// The linear values of 8-bit codes in sRGB.
static LINEAR_OF_SRGB: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| srgb_to_linear(code as f64 / 255.0) as f32));

/// The values of 8-bit codes that are linear.
static LINEAR_OF_CODE: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| (code as f64 / 255.0) as f32));

/// The linear values of 16-bit codes in sRGB.
static LINEAR_OF_DEEP_SRGB: LazyLock<Vec<f32>> =
    LazyLock::new(|| (0..=u16::MAX).map(|code| srgb_to_linear(f64::from(code) / 65_535.0) as f32).collect());

/// A texture of red, green, blue and alpha with its mip levels.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorTexture {
    size: [usize; 2],
    /// Copies share them.
    texels: Arc<RgbaCodes>,
    is_srgb: bool,
    wrap: [Wrap; 2],
    /// The levels above the texels, in linear light, each with its size.
    levels: Arc<Vec<Level>>,
}

#[derive(Clone, Debug, PartialEq)]
struct Level {
    size: [usize; 2],
    texels: Vec<[f32; 4]>,
}

impl ColorTexture {
    /// A texture that repeats.
    ///
    /// `size`: texels per row, and rows; `texels`: row after row, the top row first; `is_srgb`: whether red,
    /// green and blue are in sRGB. Errors: another number of texels.
    pub fn new(size: [u32; 2], texels: Vec<[u8; 4]>, is_srgb: bool) -> Result<Self, BakeError> {
        Self::of_codes(size, RgbaCodes::Bytes(texels), is_srgb)
    }

    /// As [`ColorTexture::new`], of codes of 8 or 16 bits.
    pub(crate) fn of_codes(size: [u32; 2], texels: RgbaCodes, is_srgb: bool) -> Result<Self, BakeError> {
        let size = size.map(|side| side as usize);
        let found = match &texels {
            RgbaCodes::Bytes(texels) => texels.len(),
            RgbaCodes::Words(texels) => texels.len(),
        };
        if size[0].checked_mul(size[1]) != Some(found) || found == 0 {
            return Err(BakeError::Texels { expected: size[0].saturating_mul(size[1]), found });
        }
        let (texels, wrap) = (Arc::new(texels), [Wrap::Repeat; 2]);
        let mut texture = Self { size, texels, is_srgb, wrap, levels: Arc::default() };
        texture.levels = Arc::new(texture.all_levels());
        Ok(texture)
    }

    /// This texture with other modes outside [0, 1], along u and v.
    #[must_use]
    pub fn with_wrap(self, wrap: [Wrap; 2]) -> Self {
        Self { wrap, ..self }
    }

    /// Texels per row, and rows.
    pub fn size(&self) -> [u32; 2] {
        self.size.map(|side| side as u32)
    }

    /// Whether red, green and blue are in sRGB.
    pub fn is_srgb(&self) -> bool {
        self.is_srgb
    }

    fn all_levels(&self) -> Vec<Level> {
        let mut levels = Vec::new();
        let mut size = self.size;
        while size != [1, 1] {
            let level = match levels.last() {
                None => half(size, |texel| self.texel(texel).map(|x| x as f32)),
                Some(Level { texels, .. }) => half(size, |texel| texels[texel]),
            };
            size = level.size;
            levels.push(level);
        }
        levels
    }

    /// A texel of the image in linear light.
    fn texel(&self, at: usize) -> Color {
        match &*self.texels {
            RgbaCodes::Bytes(texels) => {
                let [r, g, b, a] = texels[at].map(usize::from);
                let color = if self.is_srgb { &*LINEAR_OF_SRGB } else { &*LINEAR_OF_CODE };
                [color[r], color[g], color[b], LINEAR_OF_CODE[a]].map(f64::from)
            }
            RgbaCodes::Words(texels) => {
                let linear = |code: u16| f64::from(code) / 65_535.0;
                let [r, g, b, a] = texels[at];
                let color = |code: u16| match self.is_srgb {
                    true => f64::from(LINEAR_OF_DEEP_SRGB[usize::from(code)]),
                    false => linear(code),
                };
                [color(r), color(g), color(b), linear(a)]
            }
        }
    }

    /// The mean over a footprint around a UV, in linear light. `along`: the two sides of the footprint, in
    /// UVs. `None` where a number is not finite.
    pub(crate) fn mean(&self, uv: Place, along: [Place; 2]) -> Option<Color> {
        if !uv.iter().chain(along.as_flattened()).all(|x| x.is_finite()) {
            return None;
        }
        let in_texels = |v: Place| [0, 1].map(|i| v[i] * self.size[i] as f64);
        let length = |v: Place| (v[0] * v[0] + v[1] * v[1]).sqrt();
        let sides = along.map(|side| length(in_texels(side)));
        let (longer, shorter) = if sides[0] >= sides[1] { (0, 1) } else { (1, 0) };
        let taps = (sides[longer] / sides[shorter].max(1e-9)).ceil().clamp(1.0, MOST_TAPS);
        // A side of less than a texel shows a single place.
        let taps = taps.min(sides[longer].ceil().max(1.0));
        let level = level_of(sides[longer] / taps);
        let mut sum = [0.0; 4];
        for tap in 0..taps as u32 {
            let share = (f64::from(tap) + 0.5) / taps - 0.5;
            let place = [0, 1].map(|i| uv[i] + share * along[longer][i]);
            let found = self.at_level(place, level);
            sum = [0, 1, 2, 3].map(|i| sum[i] + found[i]);
        }
        Some(sum.map(|x| x / taps))
    }

    fn at_level(&self, uv: Place, level: f64) -> Color {
        let last = self.levels.len();
        let level = level.clamp(0.0, last as f64);
        let lower = level as usize;
        let share = level - lower as f64;
        let near = self.bilinear(uv, lower);
        if share == 0.0 {
            return near;
        }
        let far = self.bilinear(uv, lower + 1);
        [0, 1, 2, 3].map(|i| (1.0 - share) * near[i] + share * far[i])
    }

    fn bilinear(&self, uv: Place, level: usize) -> Color {
        let size = if level == 0 { self.size } else { self.levels[level - 1].size };
        let [columns, rows] = [0, 1].map(|i| Mix::of(uv[i] * size[i] as f64, size[i], self.wrap[i]));
        let texel = |row: usize, column: usize| match level {
            0 => self.texel(row * size[0] + column),
            _ => self.levels[level - 1].texels[row * size[0] + column].map(f64::from),
        };
        let row = |row: usize| columns.mixed(columns.texels.map(|column| texel(row, column)));
        rows.mixed(rows.texels.map(row))
    }
}

/// The level at which a length of texels is one texel: log2, linear between powers of two, so that it has the
/// same bits on every platform.
fn level_of(length: f64) -> f64 {
    if length <= 1.0 {
        return 0.0;
    }
    let bits = length.to_bits();
    let exponent = (bits >> 52) as i64 - 1023;
    let mantissa = f64::from_bits(bits & ((1 << 52) - 1) | 1023 << 52);
    exponent as f64 + mantissa - 1.0
}

/// The next level: every texel is the mean of the area that it covers.
fn half(size: [usize; 2], texel: impl Fn(usize) -> [f32; 4]) -> Level {
    let half = size.map(|side| (side / 2).max(1));
    let shares = [0, 1].map(|i| -> Vec<Vec<(usize, f64)>> {
        (0..half[i]).map(|at| covered(at, size[i] as f64 / half[i] as f64, size[i])).collect()
    });
    let mut texels = Vec::with_capacity(half[0] * half[1]);
    for rows in &shares[1] {
        for columns in &shares[0] {
            let mut sum = [0f64; 4];
            for &(row, of_row) in rows {
                for &(column, of_column) in columns {
                    let found = texel(row * size[0] + column);
                    sum = [0, 1, 2, 3].map(|i| sum[i] + of_row * of_column * f64::from(found[i]));
                }
            }
            texels.push(sum.map(|x| x as f32));
        }
    }
    Level { size: half, texels }
}

/// The texels that a texel of the next level covers along an axis, with their shares of it.
fn covered(at: usize, ratio: f64, size: usize) -> Vec<(usize, f64)> {
    let (from, to) = (at as f64 * ratio, (at + 1) as f64 * ratio);
    (from as usize..(to.ceil() as usize).min(size))
        .map(|texel| (texel, ((texel + 1) as f64).min(to) - (texel as f64).max(from)))
        .map(|(texel, length)| (texel, length / ratio))
        .filter(|&(_, share)| share > 0.0)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(size: [u32; 2], texels: &[u8], is_srgb: bool) -> ColorTexture {
        let texels = texels.iter().map(|&x| [x, x, x, x]).collect();
        ColorTexture::new(size, texels, is_srgb).expect("as many texels as the size says")
    }

    #[test]
    fn light_is_averaged_and_codes_are_not() {
        let texture = grey([2, 1], &[0, 255], true);
        let whole = [[1.0, 0.0], [0.0, 1.0]];
        let [red, .., alpha] = texture.mean([0.5, 0.5], whole).expect("finite");
        assert!((red - 0.5).abs() < 1e-6 && (alpha - 0.5).abs() < 1e-6);
        let centre = texture.mean([0.75, 0.5], [[0.0; 2]; 2]).expect("finite");
        assert_eq!(centre, [1.0; 4]);
        assert_eq!(grey([1, 1], &[51], false).mean([0.0; 2], whole).map(|x| x[0] as f32), Some(0.2));
    }

    /// Codes of 16 bits that have the values of codes of 8 bits, 257 times as large, and codes between them.
    #[test]
    fn texels_of_16_bits_keep_them() {
        let place = [[0.0; 2]; 2];
        for is_srgb in [false, true] {
            for code in 0..=255u8 {
                let (byte, word) = ([code, 255 - code, 7, code], u16::from(code));
                let deep = [257 * word, 65_535 - 257 * word, 7 * 257, 257 * word];
                let deep = ColorTexture::of_codes([1, 1], RgbaCodes::Words(vec![deep]), is_srgb);
                let [deep, plain] = [deep, ColorTexture::new([1, 1], vec![byte], is_srgb)]
                    .map(|texture| texture.expect("a texel").mean([0.5; 2], place).expect("finite"));
                let differs = |i: usize| (deep[i] - plain[i]).abs() > f64::from(f32::EPSILON);
                assert!(!(0..4).any(differs), "{deep:?} {plain:?}");
            }
            let value = |code: u16| {
                let texture = ColorTexture::of_codes([1, 1], RgbaCodes::Words(vec![[code; 4]]), is_srgb);
                texture.expect("a texel").mean([0.5; 2], place).expect("finite")
            };
            assert!((0..65_535).step_by(97).all(|code| value(code)[0] < value(code + 1)[0]));
            let alpha = value(12_345)[3];
            assert_eq!(alpha, 12_345.0 / 65_535.0);
        }
    }

    #[test]
    fn the_mean_over_the_whole_image_is_that_of_its_texels() {
        let texels: Vec<u8> = (0..35u8).map(|i| i.wrapping_mul(37)).collect();
        let mean = texels.iter().map(|&x| f64::from(x) / 255.0).sum::<f64>() / 35.0;
        let texture = grey([7, 5], &texels, false);
        // The whole image and more of its repetitions, as long as wide.
        let found = texture.mean([0.31, 0.77], [[2.0, 0.0], [0.0, 2.8]]).expect("finite");
        assert!((found[0] - mean).abs() < 1e-6, "{} {mean}", found[0]);
    }

    #[test]
    fn long_footprints_are_sharp_across() {
        // Columns that alternate: along a column nothing is mixed, across columns all is.
        let texels: Vec<u8> = (0..64 * 64).map(|i| if i % 2 == 0 { 0 } else { 255 }).collect();
        let texture = grey([64, 64], &texels, false);
        let texel = 1.0 / 64.0;
        let at = [1.5 * texel, 0.5];
        let along = texture.mean(at, [[texel, 0.0], [0.0, 8.0 * texel]]).expect("finite");
        let across = texture.mean(at, [[8.0 * texel, 0.0], [0.0, texel]]).expect("finite");
        assert!(along[0] == 1.0 && (across[0] - 0.5).abs() < 1e-6, "{along:?} {across:?}");
    }

    #[test]
    fn levels_follow_powers_of_two() {
        assert_eq!([0.3, 1.0, 2.0, 3.0, 8.0].map(level_of), [0.0, 0.0, 1.0, 1.5, 3.0]);
    }
}

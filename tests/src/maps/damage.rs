//! What storage does to the texels of a map: noise, rounding, block compression, JPEG.

use crate::Dice;

/// Red, green and blue from 0 to 255, not yet rounded.
pub type Texel = [f32; 3];

/// How a map is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Storage {
    /// Rounded to 8 bits.
    Rounded,
    /// Blocks of 4 x 4 texels, red and green each on a line of eight values (as BC5), blue likewise.
    ChannelBlocks,
    /// Blocks of 4 x 4 texels on a line of four colours (as BC1).
    ColorBlocks,
    /// Cosine transform of 8 x 8 blocks, as JPEG of this quality (1 to 100); with halved or whole colour
    /// resolution.
    Jpeg {
        /// The quality.
        quality: u32,
        /// Whether colours have half the resolution.
        halves_colors: bool,
    },
}

impl Storage {
    /// The texels after storage. `size` is the width and the height, multiples of 16.
    pub fn store(self, [width, height]: [usize; 2], mut texels: Vec<Texel>) -> Vec<[u8; 3]> {
        match self {
            Self::Rounded => {}
            Self::ChannelBlocks => each_block::<4, 16>(width, height, &mut texels, channel_block),
            Self::ColorBlocks => each_block::<4, 16>(width, height, &mut texels, color_block),
            Self::Jpeg { quality, halves_colors } => {
                jpeg(width, height, &mut texels, quality, halves_colors);
            }
        }
        texels.iter().map(|texel| texel.map(|value| value.round().clamp(0.0, 255.0) as u8)).collect()
    }
}

/// Adds normally distributed noise of this standard deviation.
pub fn add_noise(dice: &mut Dice<'_>, deviation: f32, texels: &mut [Texel]) {
    for value in texels.as_flattened_mut() {
        let sum: f32 = (0..4).map(|_| dice.uniform()).sum();
        *value += deviation * sum * 0.866;
    }
}

/// Calls `change` with every block of `SIDE` x `SIDE` texels.
fn each_block<const SIDE: usize, const AREA: usize>(
    width: usize,
    height: usize,
    texels: &mut [Texel],
    change: impl Fn(&mut [Texel; AREA]),
) {
    for (y, x) in (0..height / SIDE).flat_map(|y| (0..width / SIDE).map(move |x| (y, x))) {
        let index = |i: usize| (y * SIDE + i / SIDE) * width + x * SIDE + i % SIDE;
        let mut block = [[0.0; 3]; AREA];
        block.iter_mut().enumerate().for_each(|(i, texel)| *texel = texels[index(i)]);
        change(&mut block);
        block.iter().enumerate().for_each(|(i, texel)| texels[index(i)] = *texel);
    }
}

fn channel_block(block: &mut [Texel; 16]) {
    for channel in 0..3 {
        let values = block.map(|texel| texel[channel].round());
        let low = values.iter().copied().fold(f32::INFINITY, f32::min);
        let high = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let step = ((high - low) / 7.0).max(1e-6);
        for texel in block.iter_mut() {
            texel[channel] = low + ((texel[channel] - low) / step).round() * step;
        }
    }
}

/// The line from the lowest to the highest texel along the axis of the greatest range; the ends have 5, 6 and
/// 5 bits.
fn color_block(block: &mut [Texel; 16]) {
    let mean = [0, 1, 2].map(|i| block.iter().map(|texel| texel[i]).sum::<f32>() / 16.0);
    let mut axis = [1.0f32, 0.3, 0.1];
    for _ in 0..8 {
        let mut next = [0.0; 3];
        for texel in block.iter() {
            let from_mean = [0, 1, 2].map(|i| texel[i] - mean[i]);
            let along: f32 = (0..3).map(|i| from_mean[i] * axis[i]).sum();
            (0..3).for_each(|i| next[i] += along * from_mean[i]);
        }
        let length = next.iter().map(|x| x * x).sum::<f32>().sqrt();
        if length < 1e-6 {
            break;
        }
        axis = next.map(|x| x / length);
    }
    let along = |texel: &Texel| (0..3).map(|i| (texel[i] - mean[i]) * axis[i]).sum::<f32>();
    let positions = block.each_ref().map(along);
    let low = positions.iter().copied().fold(f32::INFINITY, f32::min);
    let high = positions.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let end = |position: f32| {
        let levels = [31.0, 63.0, 31.0];
        [0, 1, 2].map(|i| {
            let value = mean[i] + position * axis[i];
            (value / 255.0 * levels[i]).round().clamp(0.0, levels[i]) * 255.0 / levels[i]
        })
    };
    let (first, last) = (end(low), end(high));
    for (texel, position) in block.iter_mut().zip(positions) {
        let t = ((position - low) / (high - low).max(1e-6) * 3.0).round() / 3.0;
        *texel = [0, 1, 2].map(|i| first[i] + t * (last[i] - first[i]));
    }
}

/// Quantisation of brightness and colour at quality 50 (JPEG, ITU-T T.81, tables K.1 and K.2).
#[rustfmt::skip]
const BRIGHTNESS: [u32; 64] = [
    16, 11, 10, 16, 24, 40, 51, 61, 12, 12, 14, 19, 26, 58, 60, 55, 14, 13, 16, 24, 40, 57, 69, 56, 14, 17, 22, 29, 51, 87, 80, 62,
    18, 22, 37, 56, 68, 109, 103, 77, 24, 35, 55, 64, 81, 104, 113, 92, 49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99,
];
#[rustfmt::skip]
const COLOR: [u32; 64] = [
    17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99, 24, 26, 56, 99, 99, 99, 99, 99, 47, 66, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99,
];

fn jpeg(width: usize, height: usize, texels: &mut [Texel], quality: u32, halves_colors: bool) {
    for texel in texels.iter_mut() {
        let [r, g, b] = *texel;
        let brightness = 0.299 * r + 0.587 * g + 0.114 * b;
        *texel = [brightness - 128.0, (b - brightness) * 0.564, (r - brightness) * 0.713];
    }
    if halves_colors {
        each_block::<2, 4>(width, height, texels, |block| {
            let mean = [1, 2].map(|i| block.iter().map(|texel| texel[i]).sum::<f32>() / 4.0);
            block.iter_mut().for_each(|texel| [texel[1], texel[2]] = mean);
        });
    }
    let scale = if quality < 50 { 5000 / quality } else { 200 - 2 * quality };
    let step = |at_50: u32| ((at_50 * scale + 50) / 100).max(1) as f32;
    let steps = [BRIGHTNESS.map(step), COLOR.map(step), COLOR.map(step)];
    let cosines = cosines();
    each_block::<8, 64>(width, height, texels, |block| {
        for channel in 0..3 {
            let values = block.map(|texel| texel[channel]);
            let mut waves = transform(&cosines, &values, false);
            waves
                .iter_mut()
                .zip(steps[channel])
                .for_each(|(wave, step)| *wave = (*wave / step).round() * step);
            let values = transform(&cosines, &waves, true);
            block.iter_mut().zip(values).for_each(|(texel, value)| texel[channel] = value);
        }
    });
    for texel in texels.iter_mut() {
        let [brightness, blue, red] = *texel;
        let (r, b) = (brightness + 128.0 + red / 0.713, brightness + 128.0 + blue / 0.564);
        *texel = [r, (brightness + 128.0 - 0.299 * r - 0.114 * b) / 0.587, b];
    }
}

/// The orthonormal cosine transform: row k holds the k-th wave.
fn cosines() -> [[f32; 8]; 8] {
    let mut out = [[0.0; 8]; 8];
    for (k, row) in out.iter_mut().enumerate() {
        let norm = if k == 0 { 0.125f32.sqrt() } else { 0.5 };
        for (i, value) in row.iter_mut().enumerate() {
            *value = norm * ((2 * i + 1) as f32 * k as f32 * std::f32::consts::PI / 16.0).cos();
        }
    }
    out
}

fn transform(cosines: &[[f32; 8]; 8], values: &[f32; 64], inverse: bool) -> [f32; 64] {
    let factor = |k: usize, i: usize| if inverse { cosines[i][k] } else { cosines[k][i] };
    let mut rows = [0.0; 64];
    for (at, out) in rows.iter_mut().enumerate() {
        *out = (0..8).map(|i| factor(at % 8, i) * values[at / 8 * 8 + i]).sum();
    }
    let mut out = [0.0; 64];
    for (at, out) in out.iter_mut().enumerate() {
        *out = (0..8).map(|i| factor(at / 8, i) * rows[i * 8 + at % 8]).sum();
    }
    out
}

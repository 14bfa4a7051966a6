//! Maps with one part in OpenGL's convention and another one in DirectX's, as where tiles or islands from
//! several sources were put together.
//!
//! The map is cut into blocks, and each is judged alone. Blocks of fewer texels than these have too few
//! tiles: on published maps, some of 64 x 64 are decided wrongly, and none of 128 x 128.

use darboux::{BitangentDirection, MapVerdict, TexelLayout, judge_normal_map};
use darboux_io::image::RgbaImage;

/// The fewest texels along a side of a block.
const MIN_SIDE: usize = 128;

/// Larger maps have so many blocks along their shorter side.
const BLOCKS: usize = 8;

/// The smallest confidence of a block that counts.
const CLEAR: f32 = 0.99;

/// The largest probability that so many blocks of a map in one convention seem to be in the other one: of the
/// 64 blocks of a large map, one is wrong in every other map if each is sure by 99 %.
const MAX_CHANCE: f64 = 0.01;

/// The smallest root of the mean squared deviation of red and green, in units of vectors, of a block that
/// counts: two codes of 8 bits.
const MIN_DEVIATION: f64 = 2.0 / 127.5;

/// The smallest part of the energy of all clear blocks that contradicts the rest. Faint detail beside a
/// strong relief is no other part.
const MIN_SHARE: f64 = 0.02;

/// Blocks of one convention.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Part {
    /// Their number.
    pub blocks: usize,
    /// The largest absolute z score.
    pub z_score: f32,
    /// The sum of the mean squared deviations of red and green.
    pub energy: f64,
    /// The texels of the box around them, half open: left and right, top and bottom.
    pub columns: [usize; 2],
    pub rows: [usize; 2],
}

/// The parts that contradict each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contradiction {
    /// Texels along a side of a block.
    pub side: usize,
    /// The blocks in OpenGL's convention, and in DirectX's.
    pub parts: [Part; 2],
}

impl Part {
    fn add(&mut self, side: usize, [left, top]: [usize; 2], z_score: f32, energy: f64) {
        let grow = |range: [usize; 2], start: usize| [range[0].min(start), range[1].max(start + side)];
        (self.columns, self.rows) = match self.blocks {
            0 => ([left, left + side], [top, top + side]),
            _ => (grow(self.columns, left), grow(self.rows, top)),
        };
        self.blocks += 1;
        self.energy += energy;
        self.z_score = self.z_score.max(z_score.abs());
    }
}

impl Contradiction {
    /// The part that is in another convention than the wanted one.
    pub fn wrong(&self, wanted: BitangentDirection) -> &Part {
        let [up, down] = &self.parts;
        if wanted == BitangentDirection::Up { down } else { up }
    }

    /// None where all clear blocks have one convention.
    pub fn of(image: &RgbaImage) -> Option<Self> {
        let [width, height] = [image.width, image.height].map(|side| side as usize);
        let side = (width.min(height) / BLOCKS).max(MIN_SIDE);
        let mut found = Self { side, parts: [Part::default(); 2] };
        let starts = |length: usize| (0..length / side).map(move |number| number * side);
        let mut block = Vec::with_capacity(side * side);
        let mut expected_wrong = 0.0;
        for (top, left) in starts(height).flat_map(|top| starts(width).map(move |left| (top, left))) {
            block.clear();
            for row in image.texels.chunks_exact(width).skip(top).take(side) {
                block.extend_from_slice(&row[left..left + side]);
            }
            let energy = deviation(&block);
            if energy < MIN_DEVIATION * MIN_DEVIATION {
                continue;
            }
            let judgement = judge_normal_map(&block, [side; 2], TexelLayout::RGBA).ok()?;
            let part = match judgement.verdict {
                MapVerdict::OpenGl => 0,
                MapVerdict::DirectX => 1,
                _ => continue,
            };
            if judgement.confidence >= CLEAR {
                expected_wrong += 1.0 - f64::from(judgement.confidence);
                found.parts[part].add(side, [left, top], judgement.z_score, energy);
            }
        }
        let all = found.parts.iter().map(|part| part.energy).sum::<f64>();
        let is_more = |part: &Part| part.blocks > 0 && part.energy >= MIN_SHARE * all;
        let fewer = found.parts.iter().map(|part| part.blocks).min().unwrap_or(0);
        let is_chance = chance_of(fewer, expected_wrong) > MAX_CHANCE;
        (found.parts.iter().all(is_more) && !is_chance).then_some(found)
    }
}

/// The probability of at least so many independent events of which `expected` are expected: the tail of
/// Poisson's distribution.
fn chance_of(events: usize, expected: f64) -> f64 {
    let mut term = (-expected).exp();
    let mut fewer = 0.0;
    for count in 1..=events {
        fewer += term;
        term *= expected / count as f64;
    }
    1.0 - fewer
}

/// The mean squared deviation of red and green from their means, in units of vectors.
fn deviation(block: &[[u8; 4]]) -> f64 {
    let variance = |channel: usize| {
        // Of a block of 2^16 texels or fewer at a time, sums of 32 bits hold all squares.
        let (mut sum, mut squares) = (0u64, 0u64);
        for texels in block.chunks(1 << 16) {
            let codes = || texels.iter().map(|texel| u32::from(texel[channel]));
            sum += u64::from(codes().sum::<u32>());
            squares += u64::from(codes().map(|code| code * code).sum::<u32>());
        }
        let count = block.len().max(1) as f64;
        squares as f64 / count - (sum as f64 / count).powi(2)
    };
    (variance(0) + variance(1)) / (127.5 * 127.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_unsure_block_of_many_is_chance() {
        assert_eq!(chance_of(0, 0.5), 1.0);
        assert!((chance_of(1, 0.5) - 0.393).abs() < 1e-3);
        assert!((chance_of(2, 0.5) - 0.0902).abs() < 1e-3);
        assert!(chance_of(1, 43.0 * 0.001) > MAX_CHANCE);
        assert!(chance_of(1, 16.0 * 0.0002) < MAX_CHANCE);
        assert!(chance_of(4, 64.0 * 0.005) < MAX_CHANCE);
    }
}

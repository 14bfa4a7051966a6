//! What storage did to the texels of a map: enlargement without interpolation, few levels per channel, and
//! the blocks of a compression.
//!
//! All three are patterns of the grid of texels or of the codes, which no surface has by itself, and each is
//! measured in what it costs: the angle of the steps that it adds. Sums are of integers, so that they are the
//! same everywhere.

use darboux_io::image::RgbaImage;

use crate::measure::values::median;

/// What storage did to a map.
#[derive(Clone, Copy, Debug, Default)]
pub struct Storage {
    pub enlargement: Option<Enlargement>,
    pub few_levels: Option<FewLevels>,
    pub block_steps: Option<BlockSteps>,
}

/// An enlargement without interpolation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enlargement {
    /// How many times each texel is there, across and down.
    pub factors: [usize; 2],
    /// The width and height without that.
    pub size: [usize; 2],
    /// The root mean square of the steps between different texels, in degrees.
    pub step: f64,
}

/// Channels with few levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FewLevels {
    /// The bits of red and of green.
    pub bits: [u32; 2],
    /// The levels that occur in each.
    pub levels: [usize; 2],
    /// The larger step between two levels, in degrees.
    pub step: f64,
}

/// The steps at the borders of blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockSteps {
    /// Texels along the side of a block.
    pub side: usize,
    /// What a typical border adds to the steps inside of the blocks, in degrees.
    pub degrees: f64,
    /// The share of borders with larger steps than the middles of the blocks beside them.
    pub share: f64,
}

/// How many blocks of a compression have a border.
const JPEG_SIDE: usize = 8;
const TEXTURE_BLOCK_SIDE: usize = 4;

impl Storage {
    /// `file`: the bytes that the image was decoded from. KTX 2 files have blocks of 4 x 4 texels; other
    /// files have JPEG's blocks or none.
    pub fn of(image: &RgbaImage, file: &[u8]) -> Self {
        let is_ktx = file.starts_with(b"\xABKTX 20\xBB");
        let side = if is_ktx { TEXTURE_BLOCK_SIDE } else { JPEG_SIDE };
        let enlargement = Enlargement::of(image);
        // The lowest qualities of JPEG keep nothing of a block but its mean.
        let is_of_means = |found: &Enlargement| {
            file.starts_with(b"\xFF\xD8\xFF") && found.factors.iter().all(|factor| factor % JPEG_SIDE == 0)
        };
        let of_means = enlargement.filter(is_of_means);
        Self {
            enlargement: enlargement.filter(|_| of_means.is_none()),
            few_levels: FewLevels::of(image),
            block_steps: match of_means {
                Some(Enlargement { step, .. }) => Some(BlockSteps { side, degrees: step, share: 1.0 }),
                None => BlockSteps::of(image, side),
            },
        }
    }
}

/// Texel steps in degrees: the square root of a mean of squared differences of codes.
fn degrees(mean_square: f64) -> f64 {
    (mean_square.max(0.0).sqrt() / 127.5).to_degrees()
}

fn rows(image: &RgbaImage) -> std::slice::ChunksExact<'_, [u8; 4]> {
    image.texels.chunks_exact((image.width as usize).max(1))
}

/// The squared difference of red and green.
fn squared_step(a: &[u8; 4], b: &[u8; 4]) -> u64 {
    (0..2).map(|i| u64::from(a[i].abs_diff(b[i])).pow(2)).sum()
}

/// The fewest rows, and columns, that differ from the one before. Fewer may be the edges of a few parts that
/// lie on a grid.
const MIN_CHANGES: usize = 8;

impl Enlargement {
    /// The greatest common divisor of all columns that differ from the column before is the factor of the
    /// width, and the greatest common divisor of such rows is the factor of the height.
    fn of(image: &RgbaImage) -> Option<Self> {
        let width = image.width as usize;
        let mut differs = vec![false; width];
        let mut across = 0;
        for row in rows(image) {
            for x in 1..width {
                if row[x] != row[x - 1] && !differs[x] {
                    differs[x] = true;
                    across = common_divisor(across, x);
                }
            }
            if across == 1 {
                return None;
            }
        }
        let (above, below) = (rows(image), rows(image).skip(1));
        let changed: Vec<usize> =
            above.zip(below).enumerate().filter(|(_, (a, b))| a != b).map(|(y, _)| y + 1).collect();
        let down = changed.iter().copied().fold(0, common_divisor);
        let columns = differs.iter().filter(|differs| **differs).count();
        if across < 2 || down < 2 || columns.min(changed.len()) < MIN_CHANGES {
            return None;
        }
        let (mut sum, mut steps) = (0, 0u64);
        let mut add = |step: u64| (sum, steps) = (sum + step, steps + u64::from(step > 0));
        for row in rows(image) {
            (across..width).step_by(across).for_each(|x| add(squared_step(&row[x], &row[x - 1])));
        }
        let size = [width / across, image.height as usize / down];
        Some(Self { factors: [across, down], size, step: degrees(sum as f64 / steps.max(1) as f64) })
    }
}

fn common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

/// The fewest bits that are looked for, and the most.
const BITS: std::ops::RangeInclusive<u32> = 3..=6;

/// The fewest levels that show a number of bits: ten levels of a map of 8 bits are all among the 64 of 6 bits
/// once in a million maps.
const MIN_LEVELS: usize = 10;

impl FewLevels {
    fn of(image: &RgbaImage) -> Option<Self> {
        let mut used = [[false; 256]; 2];
        for row in rows(image) {
            for texel in row {
                (0..2).for_each(|i| used[i][usize::from(texel[i])] = true);
            }
            if used.iter().any(|used| bits(used).is_none()) {
                return None;
            }
        }
        let levels = used.map(|used| used.iter().filter(|used| **used).count());
        let bits = [bits(&used[0])?, bits(&used[1])?];
        let is_enough = |i: usize| levels[i] >= MIN_LEVELS.min((1 << bits[i]) - 2);
        let coarsest = bits[0].min(bits[1]);
        let step = (2.0 / f64::from((1 << coarsest) - 1)).to_degrees();
        (is_enough(0) && is_enough(1)).then_some(Self { bits, levels, step })
    }
}

/// The fewest bits whose levels hold all used codes, in one of three ways to make 8 bits of them; none above
/// [`BITS`].
fn bits(used: &[bool; 256]) -> Option<u32> {
    let truncated = |level: u32, bits: u32| level << (8 - bits);
    let repeated = |level: u32, bits: u32| {
        let high = level << (8 - bits);
        high | high >> bits | if 2 * bits < 8 { high >> (2 * bits) } else { 0 }
    };
    let rounded = |level: u32, bits: u32| (510 * level + (1 << bits) - 1) / (2 * ((1 << bits) - 1));
    let ways: [&dyn Fn(u32, u32) -> u32; 3] = [&truncated, &repeated, &rounded];
    let count = used.iter().filter(|used| **used).count();
    let holds_all = |bits: u32, way: &dyn Fn(u32, u32) -> u32| {
        (0..1 << bits).filter(|level| used[way(*level, bits) as usize]).count() == count
    };
    BITS.clone().find(|bits| ways.iter().any(|way| holds_all(*bits, way)))
}

/// The side of the part in the middle of the map that is compared.
const PART: usize = 512;

/// The largest squared second difference: a step of a quarter of the range is a border of charts.
const MAX_SQUARE: u64 = 16256;

/// What blocks add in degrees: less is not seen, and more is a grating or a grid of tiles whose edges lie on
/// the borders.
const DEGREES: std::ops::RangeInclusive<f64> = 1.0..=15.0;

/// The least share of borders that stand out, and the least ratio of their squared steps to those in the
/// middles of the blocks.
const MIN_SHARE: f64 = 0.8;
const MIN_RATIO: f64 = 1.6;

/// The fewest borders per axis.
const MIN_BORDERS: usize = 7;

impl BlockSteps {
    /// A step at a border is compared with those in the middles of the two blocks. Steps are second
    /// differences, in which even slopes cancel.
    fn of(image: &RgbaImage, side: usize) -> Option<Self> {
        let size = [image.width, image.height].map(|side| side as usize);
        let start = size.map(|length| length.saturating_sub(PART) / 2 / side * side);
        let length = [0, 1].map(|axis| size[axis].min(PART));
        let at = |x: usize, y: usize| &image.texels[(start[1] + y) * size[0] + start[0] + x];
        let axes = [
            Self::along(side, length, |along, across| at(along, across))?,
            Self::along(side, [length[1], length[0]], |along, across| at(across, along))?,
        ];
        let excess = (axes[0].excess + axes[1].excess) / 2.0;
        let (share, ratio) = (axes[0].share.min(axes[1].share), axes[0].ratio.min(axes[1].ratio));
        // The second difference of a step is twice the step.
        let degrees = degrees(excess / 4.0);
        let is_compression = share >= MIN_SHARE && ratio >= MIN_RATIO;
        (is_compression && DEGREES.contains(&degrees)).then_some(Self { side, degrees, share })
    }

    /// The borders along one axis. `length`: of that axis and of the other one.
    fn along<'a>(
        side: usize,
        length: [usize; 2],
        at: impl Fn(usize, usize) -> &'a [u8; 4],
    ) -> Option<Borders> {
        // The step before the texel `along`, summed over the other axis.
        let step = |along: usize| -> u64 {
            let square = |across: usize| {
                let texels: [&[u8; 4]; 4] = std::array::from_fn(|i| at(along + i - 2, across));
                let second = |i: usize| {
                    let [a, b, c, d] = texels.map(|texel| i64::from(texel[i]));
                    (3 * (c - b) - (d - a)).unsigned_abs().pow(2)
                };
                (second(0) + second(1)).min(MAX_SQUARE)
            };
            (0..length[1]).map(square).sum()
        };
        let (mut excesses, mut ratios, mut larger) = (Vec::new(), Vec::new(), 0);
        for border in (side..length[0].saturating_sub(side)).step_by(side) {
            let middles = [border - side / 2, border + side / 2].map(step);
            let (here, inside) = (step(border) as f64, (middles[0] + middles[1]) as f64 / 2.0);
            // A border in a flat part of the map says nothing.
            if here + inside > 0.0 {
                excesses.push((here - inside) / length[1] as f64);
                ratios.push((here + 1.0) / (inside + 1.0));
                larger += usize::from(here > inside);
            }
        }
        if excesses.len() < MIN_BORDERS {
            return None;
        }
        let share = larger as f64 / excesses.len() as f64;
        Some(Borders { excess: median(&mut excesses), ratio: median(&mut ratios), share })
    }
}

/// How the borders along one axis differ from the middles of the blocks.
struct Borders {
    /// The median of the differences of the mean squares.
    excess: f64,
    /// The median of their ratios.
    ratio: f64,
    share: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks of 8 x 8 equal texels are an enlargement in a PNG, and all that a JPEG of the lowest quality
    /// keeps.
    #[test]
    fn blocks_of_means_in_a_jpeg_are_no_enlargement() {
        let texel = |i: usize| {
            let (x, y) = (i % 128 / 8, i / 128 / 8);
            [120 + (5 * x + 3 * y) as u8 % 17, 120 + (3 * x + 7 * y) as u8 % 19, 250, 255]
        };
        let image = RgbaImage { width: 128, height: 128, texels: (0..128 * 128).map(texel).collect() };
        let png = Storage::of(&image, b"\x89PNG\r\n\x1A\n");
        assert_eq!(png.enlargement.map(|found| found.factors), Some([8, 8]));
        let jpeg = Storage::of(&image, b"\xFF\xD8\xFF\xE0");
        assert_eq!(jpeg.enlargement, None);
        let blocks = jpeg.block_steps.expect("blocks");
        assert!(blocks.side == 8 && blocks.degrees > 1.0, "{blocks:?}");
    }
}

//! Maps of which one part is in OpenGL's convention and another one in DirectX's, as where tiles or islands from several sources were put together.
//!
//! The map is cut into blocks, and each is judged alone. Blocks of fewer texels than these have too few tiles: on published maps, some of 64 x 64
//! are decided wrongly, and none of 128 x 128.

use darboux::{BitangentDirection, MapVerdict, TexelLayout, judge_normal_map};
use darboux_io::image::RgbaImage;

/// The fewest texels along a side of a block.
const MIN_SIDE: usize = 128;

/// Larger maps have so many blocks along their shorter side.
const BLOCKS: usize = 8;

/// The smallest absolute z score of a block that counts.
const CLEAR: f32 = 6.5;

/// Blocks of one convention.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Part {
    /// Their number.
    pub blocks: usize,
    /// The largest absolute z score.
    pub z_score: f32,
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
    fn add(&mut self, side: usize, [left, top]: [usize; 2], z_score: f32) {
        let grow = |range: [usize; 2], start: usize| [range[0].min(start), range[1].max(start + side)];
        (self.columns, self.rows) = match self.blocks {
            0 => ([left, left + side], [top, top + side]),
            _ => (grow(self.columns, left), grow(self.rows, top)),
        };
        self.blocks += 1;
        self.z_score = self.z_score.max(z_score.abs());
    }
}

impl Contradiction {
    /// The part that is in another convention than the wanted one.
    pub fn wrong(&self, wanted: BitangentDirection) -> &Part {
        let [up, down] = &self.parts;
        if wanted == BitangentDirection::Up { down } else { up }
    }

    /// None where all clear blocks have one convention. `layout`: the channels of x, y and z.
    pub fn of(image: &RgbaImage, layout: TexelLayout<4>) -> Option<Self> {
        let [width, height] = [image.width, image.height].map(|side| side as usize);
        let side = (width.min(height) / BLOCKS).max(MIN_SIDE);
        let mut found = Self { side, parts: [Part::default(); 2] };
        let starts = |length: usize| (0..length / side).map(move |number| number * side);
        let mut block = Vec::with_capacity(side * side);
        for (top, left) in starts(height).flat_map(|top| starts(width).map(move |left| (top, left))) {
            block.clear();
            for row in image.texels.chunks_exact(width).skip(top).take(side) {
                block.extend_from_slice(&row[left..left + side]);
            }
            let judgement = judge_normal_map(&block, [side; 2], layout).ok()?;
            let part = match judgement.verdict {
                MapVerdict::OpenGl => 0,
                MapVerdict::DirectX => 1,
                _ => continue,
            };
            if judgement.z_score.abs() >= CLEAR {
                found.parts[part].add(side, [left, top], judgement.z_score);
            }
        }
        found.parts.iter().all(|part| part.blocks > 0).then_some(found)
    }
}

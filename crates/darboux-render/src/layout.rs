//! The UV layout beside the model.

use crate::RenderOptions;

/// Where the UV layout is drawn: u to the right, v down. What lies under other triangles shows through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Over the lower right corner of the picture, in a square of half of its shorter side.
    Corner,
    /// In place of the model.
    Alone,
}

/// Pixels between the layout and the picture's edges, and around it.
const MARGIN: u32 = 12;
const BORDER: [u8; 3] = [128; 3];

/// The square of a layout in the corner.
pub struct Inset {
    picture: [u32; 2],
    side: u32,
}

impl Inset {
    /// The square; none where none is asked for, or where it would have no pixels.
    pub fn of(options: &RenderOptions) -> Option<Self> {
        let [width, height] = options.size;
        let side = (width.min(height) / 2).saturating_sub(2 * MARGIN);
        (options.layout == Some(Layout::Corner) && side > 0).then_some(Self { picture: options.size, side })
    }

    pub fn size(&self) -> [u32; 2] {
        [self.side; 2]
    }

    /// Puts the square's pixels into a picture, a line around them.
    pub fn put(&self, square: &[[u8; 3]], pixels: &mut [[u8; 3]]) {
        let [width, side] = [self.picture[0], self.side].map(|side| side as usize);
        let [left, top] = self.picture.map(|length| (length - MARGIN - self.side) as usize);
        for y in 0..side + 2 {
            let row = &mut pixels[(top + y - 1) * width + left - 1..][..side + 2];
            row.fill(BORDER);
            if (1..=side).contains(&y) {
                row[1..=side].copy_from_slice(&square[(y - 1) * side..][..side]);
            }
        }
    }
}

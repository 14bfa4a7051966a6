//! Copies the drawing of the UV layout into the lower right corner of a picture.

use crate::options::{LayoutPlacement, RenderOptions};

/// Pixels between the layout and the edges of the picture.
const MARGIN: u32 = 12;
/// The colour of the line around the layout.
const BORDER: [u8; 3] = [128; 3];

/// The square of the layout.
pub struct Inset {
    picture: [u32; 2],
    side: u32,
}

impl Inset {
    /// The square; none if the options do not ask for it, or if the picture is too small.
    pub fn of(options: &RenderOptions) -> Option<Self> {
        let [width, height] = options.size;
        let side = (width.min(height) / 2).saturating_sub(2 * MARGIN);
        (options.layout == Some(LayoutPlacement::Corner) && side > 0)
            .then_some(Self { picture: options.size, side })
    }

    pub fn size(&self) -> [u32; 2] {
        [self.side; 2]
    }

    /// Copies the pixels of the layout into a picture, and draws a line around them.
    pub fn copy_into(&self, square: &[[u8; 3]], pixels: &mut [[u8; 3]]) {
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

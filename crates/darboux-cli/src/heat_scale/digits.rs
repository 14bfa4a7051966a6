//! Numbers in pictures of the default build, which has no library for text.

/// The height of a line of numbers in pixels.
pub const HEIGHT: usize = 14;

/// The rows above the glyphs.
const ABOVE: usize = 3;

/// The width of a glyph with the space after it.
const STEP: usize = 6;

/// The ink of each glyph, row by row, in the five lowest bits of each number, the leftmost column highest.
const GLYPHS: [(char, [u8; 7]); 12] = [
    ('0', [14, 17, 19, 21, 25, 17, 14]),
    ('1', [4, 12, 4, 4, 4, 4, 14]),
    ('2', [14, 17, 1, 2, 4, 8, 31]),
    ('3', [31, 2, 4, 2, 1, 17, 14]),
    ('4', [2, 6, 10, 18, 31, 2, 2]),
    ('5', [31, 16, 30, 1, 1, 17, 14]),
    ('6', [6, 8, 16, 30, 17, 17, 14]),
    ('7', [31, 1, 2, 4, 8, 8, 8]),
    ('8', [14, 17, 17, 14, 17, 17, 14]),
    ('9', [14, 17, 17, 15, 1, 2, 12]),
    ('.', [0, 0, 0, 0, 0, 12, 12]),
    ('\u{b0}', [12, 18, 18, 12, 0, 0, 0]),
];

const INK: [u8; 3] = [235; 3];

/// The width of a text in pixels.
pub fn width(text: &str) -> usize {
    text.chars().count() * STEP
}

/// Writes a text into rows of pixels, of which there are [`HEIGHT`]. Characters without a glyph are spaces.
pub fn write(text: &str, left: usize, rows: &mut [Vec<[u8; 3]>]) {
    for (at, letter) in text.chars().enumerate() {
        let Some((_, glyph)) = GLYPHS.iter().find(|(known, _)| *known == letter) else { continue };
        for (row, bits) in glyph.iter().enumerate() {
            for column in (0..5).filter(|column| bits >> (4 - column) & 1 == 1) {
                if let Some(pixel) = rows[ABOVE + row].get_mut(left + at * STEP + column) {
                    *pixel = INK;
                }
            }
        }
    }
}

//! [`Udim`]: the numbers of the tiles of the UV plane, each of which has an image of its own.

use std::fmt;

/// A tile of the UV plane: 1001 + column + 10 * row, with columns 0 to 9 to the right and rows upwards.
///
/// Rows are counted in the direction in which images are seen: with glTF's UVs, whose v points down, the tile
/// above the first has v from -1 to 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Udim(u16);

impl Udim {
    /// Tiles per row.
    pub const COLUMNS: u16 = 10;

    /// Rows of tiles.
    pub const ROWS: u16 = 899;

    /// Digits of every number.
    pub const DIGITS: usize = 4;

    /// The tile of a number from 1001 to 9990; none for others.
    pub fn from_number(number: u32) -> Option<Self> {
        let place = number.checked_sub(1001)?;
        (place < u32::from(Self::COLUMNS * Self::ROWS)).then_some(Self(place as u16))
    }

    /// The number.
    pub fn number(self) -> u32 {
        1001 + u32::from(self.0)
    }

    /// The column and the row of the tile as the image has them: rows downwards.
    pub(crate) fn tile(self) -> [i32; 2] {
        [i32::from(self.0 % Self::COLUMNS), -i32::from(self.0 / Self::COLUMNS)]
    }

    /// The tile at a column and a row as the image has them; none where it has no number.
    pub(crate) fn of_tile([column, row]: [i32; 2]) -> Option<Self> {
        let is_known =
            (0..i32::from(Self::COLUMNS)).contains(&column) && (0..i32::from(Self::ROWS)).contains(&-row);
        is_known.then_some(Self((column + i32::from(Self::COLUMNS) * -row) as u16))
    }
}

impl fmt::Display for Udim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.number().fmt(f)
    }
}

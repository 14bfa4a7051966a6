//! Opposite directions: which of many may have a dot product of -1 with a given one, without looking at all.

use crate::math::{V3, dot, scale};

/// Two unit vectors, to 1e-6 in the square, whose rounded dot product is -1 or less have a sum shorter than this.
///
/// Rounding takes at most 2e-7 from the product and from each square, so |a + b|^2 = |a|^2 + |b|^2 + 2 a b is at most
/// 2 (1 + 1.2e-6) - 2 (1 - 2e-7) = 2.8e-6, which is (1.68e-3)^2.
const REACH: f32 = 1.0 / 512.0;
/// Twice the reach, so that what is within it lies in at most two cells along each axis.
const CELLS_PER_UNIT: f32 = 256.0;

/// Directions by the cells of a lattice.
#[derive(Debug, Default)]
pub(crate) struct Opposites {
    /// Cell and place in the list, sorted; cells that follow each other along z do so here.
    cells: Vec<(u64, u32)>,
    /// Those of which their length says nothing: not of unit length and not short either.
    odd: Vec<u32>,
}

enum Length {
    Unit,
    /// Opposite to no direction of unit length.
    Short,
    Odd,
}

impl Length {
    fn of(v: V3) -> Self {
        let square = dot(v, v);
        if (square - 1.0).abs() < 1e-6 {
            Self::Unit
        } else if square < 0.99 {
            Self::Short
        } else {
            Self::Odd
        }
    }
}

impl Opposites {
    /// Takes directions with their places in a list.
    pub fn new(directions: impl Iterator<Item = (u32, V3)>) -> Self {
        let mut opposites = Self::default();
        for (place, direction) in directions {
            match Length::of(direction) {
                Length::Unit => opposites.cells.push((cell(direction.map(cell_of)), place)),
                Length::Short => {}
                Length::Odd => opposites.odd.push(place),
            }
        }
        opposites.cells.sort_unstable();
        opposites
    }

    /// Calls `found` for the places of all that may be opposite to `direction`; none where that may be any of the list.
    pub fn near(&self, direction: V3, mut found: impl FnMut(u32)) -> Option<()> {
        self.odd.iter().for_each(|&place| found(place));
        match Length::of(direction) {
            Length::Odd => return None,
            Length::Short => return Some(()),
            Length::Unit => {}
        }
        let opposite = scale(-1.0, direction);
        let [[x0, x1], [y0, y1], [z0, z1]] = opposite.map(|x| [cell_of(x - REACH), cell_of(x + REACH)]);
        for x in x0..=x1 {
            for y in y0..=y1 {
                let first = self.cells.partition_point(|&(of, _)| of < cell([x, y, z0]));
                let last = cell([x, y, z1]);
                self.cells[first..]
                    .iter()
                    .take_while(|&&(of, _)| of <= last)
                    .for_each(|&(_, place)| found(place));
            }
        }
        Some(())
    }
}

/// The cell along one axis, of a coordinate in [-2, 2].
fn cell_of(x: f32) -> u64 {
    ((x + 2.0) * CELLS_PER_UNIT) as u64
}

/// One number per cell; 1024 cells along each axis.
fn cell([x, y, z]: [u64; 3]) -> u64 {
    x << 20 | y << 10 | z
}

//! Opposite directions: which of many may have a dot product of -1 with a given one, without looking at all.

use crate::math::{V3, dot, scale};
use crate::util::radix_sort::{pair, second, sort};

/// Two unit vectors, to 1e-6 in the square, whose rounded dot product is -1 or less have a sum shorter than this.
///
/// Rounding takes at most 2e-7 from the product and from each square, so |a + b|^2 = |a|^2 + |b|^2 + 2 a b is at most
/// 2 (1 + 1.2e-6) - 2 (1 - 2e-7) = 2.8e-6, which is (1.68e-3)^2.
const REACH: f32 = 1.0 / 512.0;
/// Twice the reach, so that what is within it lies in at most two cells along each axis.
const CELLS_PER_UNIT: f32 = 256.0;

/// Directions by the cells of a lattice.
#[derive(Debug, Default)]
pub(crate) struct AntipodeGrid {
    /// Pairs of cell and place in the list, sorted; cells that follow each other along z do so here.
    cells: Vec<u64>,
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

impl AntipodeGrid {
    /// Takes directions with their places in a list.
    pub fn new(directions: impl Iterator<Item = (u32, V3)>) -> Self {
        let mut opposites = Self::default();
        for (place, direction) in directions {
            match Length::of(direction) {
                Length::Unit => opposites.cells.push(pair(cell(direction.map(cell_of)), place)),
                Length::Short => {}
                Length::Odd => opposites.odd.push(place),
            }
        }
        sort(&mut opposites.cells);
        opposites
    }

    /// Calls `found` for the places of all that may be opposite to `direction`; none where these may be any, or more than `limit`.
    pub fn near(&self, direction: V3, limit: usize, mut found: impl FnMut(u32)) -> Option<()> {
        match Length::of(direction) {
            Length::Odd => return None,
            Length::Short => {}
            Length::Unit => {
                let mut count = 0;
                for cells in self.cells_around(scale(-1.0, direction)) {
                    count += cells.len();
                    if count > limit {
                        return None;
                    }
                    cells.iter().for_each(|&cell| found(second(cell)));
                }
            }
        }
        self.odd.iter().for_each(|&place| found(place));
        Some(())
    }

    /// What lies in the cells within reach of `middle`.
    fn cells_around(&self, middle: V3) -> impl Iterator<Item = &[u64]> {
        let [[x0, x1], [y0, y1], [z0, z1]] = middle.map(|x| [cell_of(x - REACH), cell_of(x + REACH)]);
        let columns =
            (x0..=x1).flat_map(move |x| (y0..=y1).map(move |y| [cell([x, y, z0]), cell([x, y, z1])]));
        columns.map(|[first, last]| {
            let from = &self.cells[self.cells.partition_point(|&cell| cell < pair(first, 0))..];
            &from[..from.partition_point(|&cell| cell <= pair(last, u32::MAX))]
        })
    }
}

/// The cell along one axis, of a coordinate in [-2, 2].
fn cell_of(x: f32) -> u32 {
    ((x + 2.0) * CELLS_PER_UNIT) as u32
}

/// One number per cell; 1024 cells along each axis.
fn cell([x, y, z]: [u32; 3]) -> u32 {
    x << 20 | y << 10 | z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::normalized_unless_zero;

    #[test]
    fn nothing_opposite_is_missed() {
        let wheel = |at: u32| {
            let (y, x) = (at as f32 * 0.001_570_796_4).sin_cos();
            normalized_unless_zero([x, 0.6 * y, 0.8 * y])
        };
        let special = [[0.0; 3], [f32::NAN; 3], [-1.1, 0.0, 0.0], [0.5, 0.0, 0.0]];
        let directions: Vec<V3> = (0..4000).map(wheel).chain(special).collect();
        let opposites = AntipodeGrid::new((0..).zip(directions.iter().copied()));
        let (mut apart, mut candidates) = (0, 0);
        for &direction in &directions[..4000] {
            let mut found = Vec::new();
            opposites.near(direction, usize::MAX, |place| found.push(place)).expect("of unit length");
            candidates += found.len();
            for (place, other) in (0..).zip(&directions) {
                if dot(direction, *other) <= -1.0 {
                    apart += 1;
                    assert!(found.contains(&place), "{direction:?} and {other:?}");
                }
            }
        }
        assert!(apart >= 1000 && candidates < 4000 * 40, "{apart} of {candidates}");
    }
}

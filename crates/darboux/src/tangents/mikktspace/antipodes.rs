//! Lookup of opposite directions: lists the candidates whose dot product with a given unit vector may be -1.
//!
//! Unit vectors are stored in the cells of a cubic grid of 1/256. Vectors opposite to `v` lie in the cells around `-v`.

use crate::math::{V3, dot, scale};
use crate::util::radix_sort::{pair, second, sort};

/// An upper bound of |a + b| for unit vectors a and b (|a|^2 within 1e-6 of 1) whose rounded dot product is -1 or less.
///
/// Rounding changes the product and each square by at most 2e-7, so |a + b|^2 = |a|^2 + |b|^2 + 2 a b is at most
/// 2 (1 + 1.2e-6) - 2 (1 - 2e-7) = 2.8e-6, which is (1.68e-3)^2.
const REACH: f32 = 1.0 / 512.0;
/// The inverse of the cell size. A cell is twice the reach, so that a search visits at most two cells along each axis.
const CELLS_PER_UNIT: f32 = 256.0;

/// Directions, sorted by grid cell.
#[derive(Debug, Default)]
pub(crate) struct AntipodeGrid {
    /// Pairs of cell and index of the direction, sorted. Neighbouring cells along z are adjacent.
    cells: Vec<u64>,
    /// The indices of directions that may be opposite to anything: long vectors and NaN.
    irregular: Vec<u32>,
}

enum Length {
    Unit,
    /// Too short for a dot product of -1 with a unit vector.
    Short,
    /// Long, or NaN.
    Irregular,
}

impl Length {
    fn of(v: V3) -> Self {
        let square = dot(v, v);
        if (square - 1.0).abs() < 1e-6 {
            Self::Unit
        } else if square < 0.99 {
            Self::Short
        } else {
            Self::Irregular
        }
    }
}

impl AntipodeGrid {
    /// `directions`: pairs of index and direction.
    pub fn new(directions: impl Iterator<Item = (u32, V3)>) -> Self {
        let mut grid = Self::default();
        for (index, direction) in directions {
            match Length::of(direction) {
                Length::Unit => grid.cells.push(pair(cell(direction.map(cell_of)), index)),
                Length::Short => {}
                Length::Irregular => grid.irregular.push(index),
            }
        }
        sort(&mut grid.cells);
        grid
    }

    /// Calls `visit` with the indices of all directions that may be opposite to `direction`.
    ///
    /// `None` where every direction is a candidate, or more than `limit` are.
    pub fn for_each_candidate(&self, direction: V3, limit: usize, mut visit: impl FnMut(u32)) -> Option<()> {
        match Length::of(direction) {
            Length::Irregular => return None,
            Length::Short => {}
            Length::Unit => {
                let mut count = 0;
                for cells in self.cells_around(scale(-1.0, direction)) {
                    count += cells.len();
                    if count > limit {
                        return None;
                    }
                    cells.iter().for_each(|&cell| visit(second(cell)));
                }
            }
        }
        self.irregular.iter().for_each(|&index| visit(index));
        Some(())
    }

    /// The entries of the cells within reach of `middle`.
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

/// The cell of a coordinate in [-2, 2] along one axis.
fn cell_of(x: f32) -> u32 {
    ((x + 2.0) * CELLS_PER_UNIT) as u32
}

/// The number of a cell. There are 1024 cells along each axis.
fn cell([x, y, z]: [u32; 3]) -> u32 {
    x << 20 | y << 10 | z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::normalized_unless_zero;

    #[test]
    fn nothing_opposite_is_missed() {
        let circle = |at: u32| {
            let (y, x) = (at as f32 * 0.001_570_796_4).sin_cos();
            normalized_unless_zero([x, 0.6 * y, 0.8 * y])
        };
        let special = [[0.0; 3], [f32::NAN; 3], [-1.1, 0.0, 0.0], [0.5, 0.0, 0.0]];
        let directions: Vec<V3> = (0..4000).map(circle).chain(special).collect();
        let grid = AntipodeGrid::new((0..).zip(directions.iter().copied()));
        let (mut apart, mut candidates) = (0, 0);
        for &direction in &directions[..4000] {
            let mut found = Vec::new();
            grid.for_each_candidate(direction, usize::MAX, |index| found.push(index))
                .expect("of unit length");
            candidates += found.len();
            for (index, other) in (0..).zip(&directions) {
                if dot(direction, *other) <= -1.0 {
                    apart += 1;
                    assert!(found.contains(&index), "{direction:?} and {other:?}");
                }
            }
        }
        assert!(apart >= 1000 && candidates < 4000 * 40, "{apart} of {candidates}");
    }
}

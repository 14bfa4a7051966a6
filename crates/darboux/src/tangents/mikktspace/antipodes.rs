//! Lookup of opposite directions: lists the directions whose dot product with a given unit vector is -1 or
//! less.
//!
//! Unit vectors are stored in the cells of a cubic grid of 1/256. Vectors opposite to `v` lie in the cells
//! around `-v`, and are compared with it in blocks, without branches.

use crate::exec::simd::{Task, Width};
use crate::math::{V3, dot, scale};
use crate::util::radix_sort::{first, pair, second, sort};

/// An upper bound of |a + b| for unit vectors a and b (|a|^2 within 1e-6 of 1) whose rounded dot product is
/// -1 or less.
///
/// Rounding changes the product and each square by at most 2e-7, so |a + b|^2 = |a|^2 + |b|^2 + 2 a b is at
/// most 2 (1 + 1.2e-6) - 2 (1 - 2e-7) = 2.8e-6, which is (1.68e-3)^2.
const MAX_DISTANCE: f32 = 1.0 / 512.0;
/// The inverse of the cell size. A cell is twice the reach, so that a search visits at most two cells along
/// each axis.
const CELLS_PER_UNIT: f32 = 256.0;

/// The number of directions that are compared at once.
const BLOCK: usize = 16;

/// Directions, sorted by grid cell.
#[derive(Debug, Default)]
pub(crate) struct AntipodeGrid {
    /// The cells that are not empty, and the end of each in the arrays below. Neighbouring cells along z are
    /// adjacent.
    cells: Vec<u32>,
    ends: Vec<u32>,
    /// The indices and the coordinates of unit vectors, by cell. Zeros follow, so that a block can begin at
    /// each of them.
    indices: Vec<u32>,
    axes: [Vec<f32>; 3],
    /// The directions that may be opposite to anything: long vectors and NaN.
    irregular: Vec<(u32, V3)>,
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
    /// The directions `direction(index)` of `indices`.
    pub fn new(indices: impl Iterator<Item = u32>, direction: impl Fn(u32) -> V3) -> Self {
        let mut grid = Self::default();
        let mut cells = Vec::new();
        for index in indices {
            let direction = direction(index);
            match Length::of(direction) {
                Length::Unit => cells.push(pair(cell(direction.map(cell_of)), index)),
                Length::Short => {}
                Length::Irregular => grid.irregular.push((index, direction)),
            }
        }
        sort(&mut cells);
        for cells in cells.chunk_by(|a, b| first(*a) == first(*b)) {
            grid.cells.push(first(cells[0]));
            for index in cells.iter().map(|&cell| second(cell)) {
                grid.indices.push(index);
                grid.axes.iter_mut().zip(direction(index)).for_each(|(axis, x)| axis.push(x));
            }
            grid.ends.push(grid.indices.len() as u32);
        }
        grid.indices.extend([0; BLOCK]);
        grid.axes.iter_mut().for_each(|axis| axis.extend([0.0; BLOCK]));
        grid
    }

    /// Appends the indices of all directions whose dot product with `direction` is not above -1 to `found`,
    /// some of them twice.
    ///
    /// `None` where comparing with every direction is needed: `direction` is long or NaN, or there are more
    /// than `limit` around its opposite.
    pub fn find_opposites(
        &self,
        direction: V3,
        limit: usize,
        width: Width,
        found: &mut Vec<u32>,
    ) -> Option<()> {
        match Length::of(direction) {
            Length::Irregular => return None,
            Length::Short => {}
            Length::Unit => {
                let mut count = 0;
                for (start, end) in self.ranges_around(scale(-1.0, direction)) {
                    count += end - start;
                    if count > limit {
                        return None;
                    }
                    width.run(FindOpposites { grid: self, direction, start, end, found });
                }
            }
        }
        let is_opposite = |other: &V3| !(dot(direction, *other) > -1.0);
        found.extend(self.irregular.iter().filter(|(_, other)| is_opposite(other)).map(|(index, _)| *index));
        Some(())
    }

    /// The ranges of directions in the cells within reach of `middle`.
    fn ranges_around(&self, middle: V3) -> impl Iterator<Item = (usize, usize)> {
        let [[x0, x1], [y0, y1], [z0, z1]] =
            middle.map(|x| [cell_of(x - MAX_DISTANCE), cell_of(x + MAX_DISTANCE)]);
        let columns =
            (x0..=x1).flat_map(move |x| (y0..=y1).map(move |y| [cell([x, y, z0]), cell([x, y, z1])]));
        let end_before = |at: usize| if at == 0 { 0 } else { self.ends[at - 1] as usize };
        columns.map(move |[first, last]| {
            let from = self.cells.partition_point(|&cell| cell < first);
            let count = self.cells[from..].iter().take_while(|&&cell| cell <= last).count();
            (end_before(from), end_before(from + count))
        })
    }
}

/// Finds the directions whose dot product with `direction` is -1 or less, from `start` to the end of the
/// block that `end` is in.
struct FindOpposites<'a> {
    grid: &'a AntipodeGrid,
    direction: V3,
    start: usize,
    end: usize,
    found: &'a mut Vec<u32>,
}

impl Task for FindOpposites<'_> {
    #[inline(always)]
    fn run(self) {
        for from in (self.start..self.end).step_by(BLOCK) {
            let [x, y, z] = self.grid.axes.each_ref().map(|axis| &axis[from..from + BLOCK]);
            // Loops without closures, which would be compiled for narrow vectors.
            let mut is_opposite = [false; BLOCK];
            for at in 0..BLOCK {
                is_opposite[at] = dot(self.direction, [x[at], y[at], z[at]]) <= -1.0;
            }
            let mut any = false;
            for is_opposite in is_opposite {
                any |= is_opposite;
            }
            if any {
                for (at, is_opposite) in is_opposite.into_iter().enumerate() {
                    if is_opposite {
                        self.found.push(self.grid.indices[from + at]);
                    }
                }
            }
        }
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
    use crate::exec::simd::WidthLimit;
    use crate::math::normalized_unless_zero;

    #[test]
    fn all_that_are_opposite_are_found() {
        let circle = |at: u32| {
            let (y, x) = (at as f32 * 0.001_570_796_4).sin_cos();
            normalized_unless_zero([x, 0.6 * y, 0.8 * y])
        };
        let special = [[0.0; 3], [f32::NAN; 3], [-1.1, 0.0, 0.0], [0.5, 0.0, 0.0]];
        let directions: Vec<V3> = (0..4000).map(circle).chain(special).collect();
        let grid = AntipodeGrid::new(0..4004, |index| directions[index as usize]);
        let mut count = 0;
        for &direction in &directions[..4000] {
            let mut found = Vec::new();
            let width = Width::widest(WidthLimit::default());
            grid.find_opposites(direction, usize::MAX, width, &mut found).expect("of unit length");
            found.sort_unstable();
            found.dedup();
            let opposite = |index: &u32| dot(direction, directions[*index as usize]) <= -1.0;
            let mut expected: Vec<u32> = (0..4000).filter(opposite).collect();
            count += expected.len();
            expected.push(4001);
            if dot(direction, directions[4002]) <= -1.0 {
                expected.push(4002);
            }
            assert_eq!(found, expected, "{direction:?}");
        }
        assert!(count >= 1000, "{count}");
    }
}

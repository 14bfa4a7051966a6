//! Finds the parts of UV space that are covered once, so that no pairs of triangles have to be tested there.
//!
//! Turn every triangle so that its area is positive. Edges that two triangles use in opposite directions
//! cancel; the rest is the boundary, and it winds around a point as many times as triangles cover the point.
//! Where no boundary passes, the cover is the same everywhere. So:
//!
//! ```text
//! boundary = edges of the turned triangles that do not cancel
//! in a grid of about one cell per triangle:
//!     mark the cells that the boundary comes near
//!     cover of every other cell = winding number of the boundary around its centre, added up along each row
//! a triangle may overlap another one if its bounding box meets a marked cell or one that is covered twice or more
//! ```
//!
//! All triangles that overlap others are among those, because two triangles with a common area meet in a cell
//! that is marked or covered twice. Directions of edges and areas are exact, or nearly: differences and
//! products of 32-bit floats in 64 bits. Places in the grid are rounded, and marks reach half a row and a
//! column further than the boundary.

use super::layout::{Layout, bounds, doubled_area};
use crate::measure::values::first_equal;

/// The cells that may be marked per triangle. Thousands of long thin triangles beside each other need more;
/// then all triangles may overlap.
const MARKS_PER_TRIANGLE: usize = 16;
const FREE_MARKS: usize = 1 << 16;

/// The numbers of triangles among which are all that overlap another one, ascending. They have an area.
pub fn may_overlap(layout: &Layout<'_>) -> Vec<u32> {
    let with_area: Vec<u32> = (0u32..)
        .zip(0..layout.len())
        .filter(|(_, number)| {
            let area = doubled_area(&layout.triangle(*number));
            area != 0.0 && area.is_finite()
        })
        .map(|(number, _)| number)
        .collect();
    let Some(mut grid) = Grid::new(layout, &with_area) else { return with_area };
    let marks = boundary(layout, &with_area)
        .into_iter()
        .try_fold(FREE_MARKS + MARKS_PER_TRIANGLE * with_area.len(), |marks_left, edge| {
            grid.add(layout, edge, marks_left)
        });
    if marks.is_none() {
        return with_area;
    }
    let suspects = grid.suspects_before();
    let is_suspect = |number: &u32| {
        let [low, high] = bounds(&layout.triangle(*number as usize)).map(|corner| grid.cell(corner));
        let before = |column: usize, row: usize| suspects[row * (grid.columns + 1) + column];
        let rows =
            [low[1], high[1] + 1].map(|row| before(high[0] + 1, row).wrapping_sub(before(low[0], row)));
        rows[0] != rows[1]
    };
    with_area.into_iter().filter(is_suspect).collect()
}

/// An edge of the boundary.
struct Edge {
    vertices: [u32; 2],
    /// How many more triangles use it in this direction than in the other one; negative for fewer.
    count: i32,
}

/// The edges of triangles, all turned to have a positive area, that do not cancel. Vertices with the same UV
/// are one.
fn boundary(layout: &Layout<'_>, triangles: &[u32]) -> Vec<Edge> {
    let place_of_vertex = first_equal(layout.uvs);
    let edges = || {
        triangles.iter().flat_map(|&number| {
            let vertices = layout.vertices(number as usize);
            let is_turned = doubled_area(&layout.triangle(number as usize)) < 0.0;
            [(0, 1), (1, 2), (2, 0)].map(|(from, to)| {
                let [from, to] = [from, to].map(|corner: usize| place_of_vertex[vertices[corner] as usize]);
                let is_backward = (from > to) != is_turned;
                ([from.min(to), from.max(to)], is_backward)
            })
        })
    };
    // A counting sort by the lower vertex.
    let mut end_of_vertex = vec![0usize; layout.uvs.len() + 1];
    edges().for_each(|([lower, _], _)| end_of_vertex[lower as usize + 1] += 1);
    for vertex in 1..end_of_vertex.len() {
        end_of_vertex[vertex] += end_of_vertex[vertex - 1];
    }
    let mut others = vec![(0u32, false); 3 * triangles.len()];
    for ([lower, upper], is_backward) in edges() {
        let end = &mut end_of_vertex[lower as usize];
        others[*end] = (upper, is_backward);
        *end += 1;
    }
    let (mut boundary, mut start) = (Vec::new(), 0);
    for (lower, &end) in (0u32..).zip(&end_of_vertex[..layout.uvs.len()]) {
        others[start..end].sort_unstable();
        for same in others[start..end].chunk_by(|a, b| a.0 == b.0) {
            let count = same.iter().map(|(_, is_backward)| if *is_backward { -1 } else { 1 }).sum();
            if count != 0 {
                boundary.push(Edge { vertices: [lower, same[0].0], count });
            }
        }
        start = end;
    }
    boundary
}

/// Cells over the bounding box of all triangles.
struct Grid {
    low: [f64; 2],
    /// Cells per unit of length.
    scale: [f64; 2],
    columns: usize,
    rows: usize,
    /// Per cell, row by row: what it adds to the cover of the cells from it to the right.
    steps: Vec<i32>,
    is_marked: Vec<bool>,
}

impl Grid {
    /// None where the triangles span no area.
    fn new(layout: &Layout<'_>, triangles: &[u32]) -> Option<Self> {
        let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for number in triangles {
            let [low_of_one, high_of_one] = bounds(&layout.triangle(*number as usize));
            for i in 0..2 {
                low[i] = low[i].min(low_of_one[i]);
                high[i] = high[i].max(high_of_one[i]);
            }
        }
        let per_side = (triangles.len() as f64).sqrt().ceil().max(4.0);
        let scale = [0, 1].map(|i| per_side / (high[i] - low[i]));
        let [columns, rows] = [per_side as usize; 2];
        let is_usable = scale.iter().all(|scale| scale.is_finite() && *scale > 0.0);
        let (steps, is_marked) = (vec![0; columns * rows], vec![false; columns * rows]);
        is_usable.then_some(Self { low, scale, columns, rows, steps, is_marked })
    }

    /// The column and the row of a point; those of the nearest cell outside the grid.
    fn cell(&self, [x, y]: [f64; 2]) -> [usize; 2] {
        // The conversion takes negative numbers to 0.
        let column = ((x - self.low[0]) * self.scale[0]) as usize;
        let row = ((y - self.low[1]) * self.scale[1]) as usize;
        [column.min(self.columns - 1), row.min(self.rows - 1)]
    }

    /// Adds an edge of the boundary: marks the cells near it, and counts where it crosses the middles of
    /// rows. Returns the marks that are left; none if there are too few.
    fn add(&mut self, layout: &Layout<'_>, edge: Edge, mut marks_left: usize) -> Option<usize> {
        let [a, b] = edge.vertices.map(|vertex| layout.uv(vertex));
        let at = |y: f64| a[0] + ((y - a[1]) / (b[1] - a[1])).clamp(0.0, 1.0) * (b[0] - a[0]);
        let [first, last] = [a[1].min(b[1]), a[1].max(b[1])].map(|y| self.cell([0.0, y])[1]);
        for row in first..=last {
            let y = |offset: f64| self.low[1] + (row as f64 + offset) / self.scale[1];
            let ends = if a[1] == b[1] { [a[0], b[0]] } else { [at(y(-0.5)), at(y(1.5))] };
            let [left, right] = [ends[0].min(ends[1]), ends[0].max(ends[1])].map(|x| self.cell([x, 0.0])[0]);
            let (left, right) = (left.saturating_sub(1), (right + 1).min(self.columns - 1));
            marks_left = marks_left.checked_sub(right - left + 1)?;
            let cells = row * self.columns;
            self.is_marked[cells + left..=cells + right].fill(true);
            let middle = y(0.5);
            if (a[1] <= middle) != (b[1] <= middle) {
                let column = self.cell([at(middle), 0.0])[0];
                // An edge that leads down has the inner side of a positive triangle on its right.
                self.steps[cells + column] += if a[1] > b[1] { edge.count } else { -edge.count };
            }
        }
        Some(marks_left)
    }

    /// The number of cells left of and above every corner of the grid, row by row, that are marked or covered
    /// more than once.
    fn suspects_before(&self) -> Vec<u32> {
        let width = self.columns + 1;
        let mut before = vec![0; width * (self.rows + 1)];
        for row in 0..self.rows {
            let (mut cover, mut in_row) = (0, 0);
            for column in 0..self.columns {
                let cell = row * self.columns + column;
                cover += self.steps[cell];
                in_row += u32::from(self.is_marked[cell] || cover > 1);
                before[(row + 1) * width + column + 1] = before[row * width + column + 1] + in_row;
            }
        }
        before
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `side` x `side` quads over the unit square, `uv` of every vertex changed.
    fn suspects(side: u32, change: impl Fn([f32; 2]) -> [f32; 2]) -> (usize, usize) {
        let uvs: Vec<[f32; 2]> = (0..=side)
            .flat_map(|row| (0..=side).map(move |column| [column, row].map(|i| i as f32 / side as f32)))
            .map(change)
            .collect();
        let vertex_of_corner: Vec<u32> = (0..side * side)
            .map(|quad| quad / side * (side + 1) + quad % side)
            .flat_map(|a| [a, a + 1, a + side + 2, a, a + side + 2, a + side + 1])
            .collect();
        let layout = Layout { uvs: &uvs, vertex_of_corner: &vertex_of_corner };
        (may_overlap(&layout).len(), layout.len())
    }

    /// Only the triangles at the border of a simple layout are tested in pairs, and all those of a folded
    /// one.
    #[test]
    fn only_suspects_are_tested() {
        let (found, all) = suspects(64, |uv| uv);
        assert!(found < all / 8, "{found} of {all}");
        let (found, _) = suspects(64, |[u, v]| [0.3 * u - v, u + 0.2 * v * v]);
        assert!(found < all / 4, "{found} of {all}");
        assert_eq!(suspects(64, |[u, v]| [(u - 0.5).abs(), v]).0, all);
    }
}

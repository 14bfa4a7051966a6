//! The triangles nearest to texels near charts. There a filter mixes a chart's texels with those outside,
//! which must continue the chart: a copy of the nearest texel would be wrong by what the content changes over
//! a texel.

use crate::LowSurface;
use crate::coverage::TEXELS;
use crate::layout::{BLOCK, Layout, TileTriangle};
use crate::vector::Place;

/// The distance in texels between a texel's centre and a triangle up to which the triangle is continued: more
/// than the diagonal of a texel.
const REACH: f64 = 1.5;

/// For every texel of a block the triangle nearest to its centre, of those within [`REACH`]; the first of
/// several.
#[derive(Debug)]
pub struct Gutter {
    nearest: Vec<Option<(f64, TileTriangle)>>,
}

impl Gutter {
    /// Finds the triangles. `triangles`: of the block, in order, with their corners in texels from its upper
    /// left corner.
    pub fn of(triangles: impl Iterator<Item = (TileTriangle, [Place; 3])>) -> Self {
        let mut nearest: Vec<Option<(f64, TileTriangle)>> = vec![None; TEXELS];
        for (triangle, corners) in triangles {
            let range = |i: usize| {
                let least = corners.iter().map(|corner| corner[i]).fold(f64::INFINITY, f64::min);
                let greatest = corners.iter().map(|corner| corner[i]).fold(f64::NEG_INFINITY, f64::max);
                let texel = |x: f64| x.clamp(0.0, BLOCK as f64) as usize;
                texel((least - REACH).floor())..texel((greatest + REACH).ceil())
            };
            for y in range(1) {
                for x in range(0) {
                    let texel = &mut nearest[y * BLOCK + x];
                    if texel.is_some_and(|(square, _)| square == 0.0) {
                        continue;
                    }
                    let square = square_of_distance([x as f64 + 0.5, y as f64 + 0.5], corners);
                    if square < REACH * REACH && texel.is_none_or(|(other, _)| square < other) {
                        *texel = Some((square, triangle));
                    }
                }
            }
        }
        Self { nearest }
    }

    /// The gutter of a block of a layout, given by its column and row.
    pub fn of_block(layout: &Layout, low: &[LowSurface<'_>], [column, row]: [usize; 2]) -> Self {
        let first = [column, row].map(|at| (at * BLOCK) as f64);
        Self::of(layout.block(column, row).map(|triangle| {
            let corners = layout.texels(&low[triangle.surface as usize], triangle);
            (*triangle, corners.map(|corner| [corner[0] - first[0], corner[1] - first[1]]))
        }))
    }

    /// The triangle nearest to a texel of the block.
    pub fn nearest(&self, texel: usize) -> Option<TileTriangle> {
        self.nearest[texel].map(|(_, triangle)| triangle)
    }
}

/// The square of the distance from a place to a triangle; 0 inside it.
fn square_of_distance(at: Place, [a, b, c]: [Place; 3]) -> f64 {
    let side = |p: Place, q: Place| (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0]);
    let sides = [side(a, b), side(b, c), side(c, a)];
    if sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0) {
        return 0.0;
    }
    [(a, b), (b, c), (c, a)].map(|(p, q)| to_edge(at, p, q)).into_iter().fold(f64::INFINITY, f64::min)
}

/// The square of the distance from a place to an edge.
fn to_edge(at: Place, p: Place, q: Place) -> f64 {
    let along = [q[0] - p[0], q[1] - p[1]];
    let from = [at[0] - p[0], at[1] - p[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let share = (from[0] * along[0] + from[1] * along[1]) / square;
    let share = if square > 0.0 { share.clamp(0.0, 1.0) } else { 0.0 };
    let [x, y] = [0, 1].map(|i| from[i] - share * along[i]);
    x * x + y * y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_corners_edges_and_insides() {
        let triangle = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
        let squares =
            [[1.0, 1.0], [-3.0, -4.0], [2.0, -2.0], [4.0, 4.0]].map(|at| square_of_distance(at, triangle));
        assert_eq!(squares, [0.0, 25.0, 4.0, 8.0]);
    }

    #[test]
    fn the_first_of_equally_near_triangles_counts_and_far_texels_have_none() {
        let tile_triangle = |index| TileTriangle { surface: 0, index, tile: [0; 2] };
        let left = [[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]];
        let gutter = Gutter::of([(tile_triangle(7), left), (tile_triangle(8), left)].into_iter());
        assert_eq!([0, 9, 31].map(|texel| gutter.nearest(texel)), [Some(tile_triangle(7)), None, None]);
        // The centre of texel (8, 0) is 1.0 / sqrt(2) away from the slanted edge.
        assert_eq!(gutter.nearest(8), Some(tile_triangle(7)));
    }
}

//! Stage 2: which triangle covers each sample of a block.
//!
//! Corners are rounded to 1 / 256 texel, so the test is exact. A sample on an edge belongs to the triangle
//! that contains the point a little to the right of it (and below it, if that decides nothing): two triangles
//! that share an edge neither overlap there nor leave a gap.

use crate::layout::{BLOCK, TileTriangle, area};
use crate::samples::STEPS;

/// Texels per block.
pub const TEXELS: usize = BLOCK * BLOCK;

/// The texels of a block that still need triangles. Where many triangles lie over each other, most of them
/// find none.
#[derive(Clone, Debug)]
pub struct Open {
    /// One bit per texel.
    rows: [u32; BLOCK],
}

impl Open {
    /// All texels.
    pub const ALL: Self = Self { rows: [u32::MAX; BLOCK] };

    /// Visits the open texels whose sample a triangle covers, and closes those for which `visit` returns
    /// true. `corners`: in steps from the upper left corner of the block; `sample`: the place of the
    /// samples within their texels.
    pub fn visit_covered(
        &mut self,
        corners: [[i64; 2]; 3],
        sample: [i64; 2],
        mut visit: impl FnMut(usize) -> bool,
    ) {
        let [a, b, c] = if area(corners) < 0 { [corners[0], corners[2], corners[1]] } else { corners };
        let edges = [Edge::new(a, b), Edge::new(b, c), Edge::new(c, a)];
        let range = |i: usize| {
            let least = corners.iter().map(|corner| corner[i]).fold(i64::MAX, i64::min) - sample[i];
            let greatest = corners.iter().map(|corner| corner[i]).fold(i64::MIN, i64::max) - sample[i];
            let first = (least + STEPS - 1).div_euclid(STEPS).clamp(0, BLOCK as i64);
            let end = (greatest.div_euclid(STEPS) + 1).clamp(0, BLOCK as i64);
            first as usize..end as usize
        };
        let columns = range(0);
        let of_columns = (1u64 << columns.end).wrapping_sub(1 << columns.start.min(columns.end)) as u32;
        for y in range(1) {
            let mut rest = self.rows[y] & of_columns;
            while rest != 0 {
                let x = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                let at = [x, y].map(|texel| texel as i64 * STEPS);
                let at = [at[0] + sample[0], at[1] + sample[1]];
                if edges.iter().all(|edge| edge.has_inside(at)) && visit(y * BLOCK + x) {
                    self.rows[y] &= !(1 << x);
                }
            }
        }
    }
}

/// The triangles that cover the texels of a block, for one sample per texel.
#[derive(Debug)]
pub struct Coverage {
    /// The first triangle, in the order of surfaces and triangles, that covers each sample.
    pub owners: Vec<Option<TileTriangle>>,
    /// Whether more than one triangle covers the sample.
    pub overlaps: Vec<bool>,
    /// The texels without an overlap.
    open: Open,
}

impl Coverage {
    pub fn new() -> Self {
        Self { owners: vec![None; TEXELS], overlaps: vec![false; TEXELS], open: Open::ALL }
    }

    pub fn clear(&mut self) {
        self.owners.fill(None);
        self.overlaps.fill(false);
        self.open = Open::ALL;
    }

    /// Adds a triangle. `corners`: in steps from the upper left corner of the block; `sample`: the place of
    /// the samples within their texels.
    pub fn add(&mut self, triangle: TileTriangle, corners: [[i64; 2]; 3], sample: [i64; 2]) {
        let Self { owners, overlaps, open } = self;
        open.visit_covered(corners, sample, |texel| {
            overlaps[texel] = owners[texel].is_some();
            owners[texel].get_or_insert(triangle);
            overlaps[texel]
        });
    }
}

/// An edge of a triangle that turns from x to y.
struct Edge {
    from: [i64; 2],
    along: [i64; 2],
    /// The least value of the edge function that counts as inside: 0 for edges that own their points, else
    /// 1.
    least: i64,
}

impl Edge {
    fn new(from: [i64; 2], to: [i64; 2]) -> Self {
        let along = [to[0] - from[0], to[1] - from[1]];
        // The edge function grows to the right where the edge runs upwards, and downwards where it runs to
        // the right.
        let owns_points = along[1] < 0 || (along[1] == 0 && along[0] > 0);
        Self { from, along, least: if owns_points { 0 } else { 1 } }
    }

    fn has_inside(&self, at: [i64; 2]) -> bool {
        let value = self.along[0] * (at[1] - self.from[1]) - self.along[1] * (at[0] - self.from[0]);
        value >= self.least
    }
}

#[cfg(test)]
mod tests {
    use darboux_dice::Dice;

    use super::*;

    /// Whether a triangle contains a point that is moved right by e and down by e * e, for an infinitely
    /// small e.
    fn contains(corners: [[i64; 2]; 3], at: [i64; 2]) -> bool {
        let [a, b, c] = corners;
        let side = |p: [i64; 2], q: [i64; 2]| {
            let value = area([p, q, at]);
            let by_x = -(q[1] - p[1]);
            let by_y = q[0] - p[0];
            [value, by_x, by_y].into_iter().find(|&x| x != 0).map_or(0, i64::signum)
        };
        let sides = [side(a, b), side(b, c), side(c, a)];
        area(corners) != 0 && (sides == [1; 3] || sides == [-1; 3])
    }

    fn tile_triangle(index: u32) -> TileTriangle {
        TileTriangle { surface: 0, index, tile: [0; 2] }
    }

    /// The slow twin: every sample against every triangle.
    #[test]
    fn owners_and_overlaps_are_those_of_a_test_of_all_triangles() {
        let mut dice = Dice::from_seed(5);
        for round in 0..300 {
            // Coarse grids of corners make many samples lie on edges.
            let unit = [1, 64, 128, 256][round % 4];
            let range = 2 * BLOCK * STEPS as usize / unit;
            let mut corner = || [0, 1].map(|_| (dice.below(range.min(65_536)) * unit) as i64 - 16 * STEPS);
            let triangles: Vec<_> = (0..6).map(|_| [corner(), corner(), corner()]).collect();
            let sample = [[128, 128], [64, 192]][round % 2];
            let mut coverage = Coverage::new();
            for (index, &corners) in triangles.iter().enumerate().filter(|(_, corners)| area(**corners) != 0)
            {
                coverage.add(tile_triangle(index as u32), corners, sample);
            }
            for texel in 0..TEXELS {
                let at = [texel % BLOCK, texel / BLOCK].map(|x| x as i64 * STEPS);
                let at = [at[0] + sample[0], at[1] + sample[1]];
                let mut owners = (0..triangles.len()).filter(|&i| contains(triangles[i], at));
                let expected = owners.next().map(|index| index as u32);
                assert_eq!(coverage.owners[texel].map(|triangle| triangle.index), expected, "texel {texel}");
                assert_eq!(coverage.overlaps[texel], owners.next().is_some(), "texel {texel}");
            }
        }
    }

    #[test]
    fn triangles_that_share_edges_cover_every_sample_once() {
        let mut dice = Dice::from_seed(9);
        let side = BLOCK as i64 * STEPS;
        for _ in 0..100 {
            let centre = [0, 1].map(|_| (dice.below(BLOCK + 1) as i64 * STEPS).min(side));
            let corners = [[0, 0], [side, 0], [side, side], [0, side]];
            let mut coverage = Coverage::new();
            for i in 0..4 {
                let triangle = [centre, corners[i], corners[(i + 1) % 4]];
                if area(triangle) != 0 {
                    coverage.add(tile_triangle(i as u32), triangle, [0, 0]);
                }
            }
            assert!(coverage.owners.iter().all(Option::is_some));
            assert!(!coverage.overlaps.contains(&true));
        }
    }
}

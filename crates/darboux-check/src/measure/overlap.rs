//! Finds the triangles that share area with other triangles in UV space.
//!
//! Every pair of triangles that could meet is tested exactly (by separating edges). The pairs come from
//! square grids, one per power of two:
//!
//! ```text
//! leave out the triangles that lie where UV space is covered once (single_cover.rs): most of them, in most meshes
//! for each other triangle, the largest first:
//!     for each grid of the same or a larger cell size:
//!         test the triangles in the cells that the triangle's bounding box meets
//!     put the triangle into the cells of the smallest grid whose cells are as large as its bounding box: at most four
//! ```
//!
//! UVs are taken as they are, without wrapping: parts that were moved by a whole tile do not overlap, and
//! bakers leave them out.

mod layout;
mod single_cover;

use std::collections::{BTreeMap, HashMap};

use self::layout::{Layout, Triangle, bounds, doubled_area};
use self::single_cover::may_overlap;

/// The result.
#[derive(Debug, PartialEq)]
pub struct Overlaps {
    /// The numbers of the triangles that share area with another one, ascending.
    pub triangles: Vec<usize>,
    /// Their part of the area of all triangles in UV space.
    pub area_share: f64,
    /// Whether all pairs were tested. Thousands of long thin triangles beside each other are not.
    pub is_complete: bool,
}

/// Pairs that are tested per triangle, on average, before the search stops; and for small meshes.
const TESTS_PER_TRIANGLE: usize = 128;
const FREE_TESTS: usize = 1 << 20;

/// How far triangles may reach into each other in units of the last place of their coordinates: UVs are
/// rounded to 32-bit floats.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// Finds overlapping triangles. `vertex_of_corner`: three per triangle. Triangles without area, or with UVs
/// that are not finite, overlap nothing.
pub fn overlapping(uvs: &[[f32; 2]], vertex_of_corner: &[u32]) -> Overlaps {
    let layout = Layout { uvs, vertex_of_corner };
    let mut order: Vec<(i32, u32)> = may_overlap(&layout)
        .into_iter()
        .map(|number| (level(&layout.triangle(number as usize)), number))
        .collect();
    // Triangles in the order of the file are near each other, so the sort keeps that order.
    order.sort_by_key(|(level, _)| std::cmp::Reverse(*level));
    let mut search = Search::new(&layout);
    let is_complete = order.into_iter().try_for_each(|(level, number)| search.add(level, number)).is_some();
    let found: Vec<usize> = (0..layout.len()).filter(|&number| search.is_overlapping[number]).collect();
    let area = |number: usize| doubled_area(&layout.triangle(number)).abs();
    let sum = |numbers: &mut dyn Iterator<Item = usize>| {
        numbers.map(area).filter(|area| area.is_finite()).sum::<f64>()
    };
    let all = if found.is_empty() { 0.0 } else { sum(&mut (0..layout.len())) };
    Overlaps {
        area_share: if all > 0.0 { sum(&mut found.iter().copied()) / all } else { 0.0 },
        triangles: found,
        is_complete,
    }
}

/// The triangles of a cell. Those that overlap something already are tested only until one of them is found
/// to overlap.
#[derive(Default)]
struct Cell {
    free: Vec<u32>,
    overlapping: Vec<u32>,
}

type Cells = HashMap<[i64; 2], Cell>;

struct Search<'a> {
    layout: &'a Layout<'a>,
    is_overlapping: Vec<bool>,
    /// The grids by the exponent of their cell size.
    grids: BTreeMap<i32, Cells>,
    tests_left: usize,
}

impl<'a> Search<'a> {
    fn new(layout: &'a Layout<'a>) -> Self {
        let tests_left = FREE_TESTS + TESTS_PER_TRIANGLE.saturating_mul(layout.len());
        Self { layout, is_overlapping: vec![false; layout.len()], grids: BTreeMap::new(), tests_left }
    }

    /// Tests a triangle against those that were added before, none of which is in a finer grid, and adds it.
    /// Nothing is done, and none returned, once no tests are left.
    fn add(&mut self, level: i32, number: u32) -> Option<()> {
        let triangle = self.layout.triangle(number as usize);
        let [low, high] = bounds(&triangle);
        for (&exponent, cells) in &mut self.grids {
            for place in places(low, high, exponent) {
                let Some(cell) = cells.get_mut(&place) else { continue };
                let tests_left = &mut self.tests_left;
                let share_area = |other: u32| {
                    *tests_left = tests_left.checked_sub(1)?;
                    Some(share_area(&triangle, &self.layout.triangle(other as usize)))
                };
                cell.test(number as usize, &mut self.is_overlapping, share_area)?;
            }
        }
        let is_overlapping = self.is_overlapping[number as usize];
        let cells = self.grids.entry(level).or_default();
        for place in places(low, high, level) {
            let cell = cells.entry(place).or_default();
            if is_overlapping { &mut cell.overlapping } else { &mut cell.free }.push(number);
        }
        Some(())
    }
}

impl Cell {
    /// Notes which triangles of the cell overlap the triangle `number`, and whether it overlaps any. None:
    /// `share_area` gives no more answers.
    fn test(
        &mut self,
        number: usize,
        is_overlapping: &mut [bool],
        mut share_area: impl FnMut(u32) -> Option<bool>,
    ) -> Option<()> {
        let mut at = 0;
        while let Some(&other) = self.free.get(at) {
            if !is_overlapping[other as usize] && share_area(other)? {
                (is_overlapping[other as usize], is_overlapping[number]) = (true, true);
            }
            if is_overlapping[other as usize] {
                self.overlapping.push(self.free.swap_remove(at));
            } else {
                at += 1;
            }
        }
        let mut rest = self.overlapping.iter();
        while !is_overlapping[number] {
            let Some(&other) = rest.next() else { break };
            is_overlapping[number] = share_area(other)?;
        }
        Some(())
    }
}

/// The cells of a grid that a box meets.
fn places(low: [f64; 2], high: [f64; 2], exponent: i32) -> impl Iterator<Item = [i64; 2]> {
    let size = 2.0f64.powi(exponent);
    let [first, last] = [low, high].map(|corner| corner.map(|x| (x / size).floor() as i64));
    (first[0]..=last[0]).flat_map(move |i| (first[1]..=last[1]).map(move |j| [i, j]))
}

/// The exponent of the smallest power of two that is not below the longer side of the bounding box.
fn level(triangle: &Triangle) -> i32 {
    let [low, high] = bounds(triangle);
    (high[0] - low[0]).max(high[1] - low[1]).log2().ceil() as i32
}

/// Whether two triangles with area have more in common than a line, up to rounding.
fn share_area(a: &Triangle, b: &Triangle) -> bool {
    let largest = a.iter().chain(b).flatten().fold(0.0f64, |largest, x| largest.max(x.abs()));
    let tolerance = ROUNDING * largest;
    !has_separating_edge(a, b, tolerance) && !has_separating_edge(b, a, tolerance)
}

/// Whether all of `b` lies on the outer side of an edge of `a`.
fn has_separating_edge(a: &Triangle, b: &Triangle, tolerance: f64) -> bool {
    let inner = doubled_area(a).signum();
    (0..3).any(|i| {
        let (start, end) = (a[i], a[(i + 1) % 3]);
        let [x, y] = [end[0] - start[0], end[1] - start[1]];
        let reach = tolerance * (x * x + y * y).sqrt();
        b.iter().all(|at| inner * (x * (at[1] - start[1]) - y * (at[0] - start[0])) <= reach)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use darboux_tests::Dice;

    /// Triangles without common vertices.
    fn in_order(uvs: &[[f32; 2]]) -> Vec<u32> {
        (0..uvs.len() as u32).collect()
    }

    fn found(uvs: &[[f32; 2]]) -> Vec<usize> {
        overlapping(uvs, &in_order(uvs)).triangles
    }

    const CORNER: [[f32; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

    fn moved(triangle: [[f32; 2]; 3], [u, v]: [f32; 2]) -> [[f32; 2]; 3] {
        triangle.map(|[x, y]| [x + u, y + v])
    }

    #[test]
    fn neighbours_do_not_overlap_and_stacks_do() {
        let other_half = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let folded = [[1.0, 0.0], [0.0, 1.0], [0.2, 0.2]];
        assert_eq!(found(&[CORNER, other_half].concat()), [0usize; 0]);
        assert_eq!(found(&[CORNER, folded].concat()), [0, 1]);
        assert_eq!(found(&[CORNER, CORNER, moved(CORNER, [1.0, 0.0])].concat()), [0, 1]);
        let inside = CORNER.map(|[u, v]| [0.1 + 0.001 * u, 0.1 + 0.001 * v]);
        assert_eq!(found(&[inside, moved(CORNER, [5.0, 5.0]), CORNER].concat()), [0, 2]);
        let crossing = [[-1.0, 0.4], [3.0, 0.41], [-1.0, 0.42]];
        assert_eq!(found(&[CORNER, crossing].concat()), [0, 1]);
        let line = [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]];
        let nowhere = [[0.0, 0.0], [f32::NAN, 0.0], [0.0, f32::INFINITY]];
        assert_eq!(found(&[CORNER, line, nowhere].concat()), [0usize; 0]);
    }

    #[test]
    fn the_area_is_that_of_the_overlapping_triangles() {
        let uvs = [CORNER, CORNER, moved(CORNER, [2.0, 0.0]), moved(CORNER, [4.0, 0.0])].concat();
        let found = overlapping(&uvs, &in_order(&uvs));
        assert_eq!((found.area_share, found.is_complete), (0.5, true));
    }

    /// The grids lose no pair: the same as when all pairs are tested. Coordinates are few, so that many edges
    /// and corners touch.
    #[test]
    fn grids_find_what_all_pairs_give() {
        for seed in 0..300 {
            let mut dice = Dice::from_seed(seed);
            let count = 2 + dice.below(40);
            let scale = dice.pick(&[1.0, 0.01, 1000.0]);
            let mut corner = |[u, v]: [f32; 2], size: f32| {
                [0, 1].map(|i| scale * ([u, v][i] + size * dice.below(5) as f32))
            };
            let uvs: Vec<[f32; 2]> = (0..count)
                .flat_map(|i| {
                    let at = [(i * 7 % 11) as f32, (i * 5 % 13) as f32];
                    let size = [0.25, 0.5, 3.0][i % 3];
                    [corner(at, size), corner(at, size), corner(at, size)]
                })
                .collect();
            let triangles: Vec<Triangle> =
                uvs.as_chunks::<3>().0.iter().map(|triangle| triangle.map(|uv| uv.map(f64::from))).collect();
            let has_area = |i: usize| doubled_area(&triangles[i]) != 0.0;
            let meets = |i: usize| {
                (0..count).any(|j| i != j && has_area(j) && share_area(&triangles[i], &triangles[j]))
            };
            let expected: Vec<usize> = (0..count).filter(|&i| has_area(i) && meets(i)).collect();
            assert_eq!(found(&uvs), expected, "seed {seed}");
        }
    }

    /// Leaving out what is covered once loses no pair either: patches of many triangles, turned, mirrored and
    /// laid over each other.
    #[test]
    fn patches_give_what_all_pairs_give() {
        for seed in 0..20 {
            let mut dice = Dice::from_seed(seed);
            let side = 3 + dice.below(9) as u32;
            let (mut uvs, mut vertex_of_corner) = (Vec::new(), Vec::new());
            for _ in 0..1 + dice.below(3) {
                let [a, b, c, d] = [0; 4].map(|_| dice.below(9) as f32 / 4.0 - 1.0);
                let [x, y] = [0; 2].map(|_| dice.below(5) as f32 / 4.0);
                let bend = dice.pick(&[0.0, 0.0, 0.7]);
                let first = uvs.len() as u32;
                for row in 0..=side {
                    for column in 0..=side {
                        let [u, v] = [column, row].map(|i| i as f32 / side as f32);
                        uvs.push([x + a * u + b * v, y + c * u + d * v + bend * u * u]);
                    }
                }
                for quad in 0..side * side {
                    let at = first + quad / side * (side + 1) + quad % side;
                    vertex_of_corner.extend([at, at + 1, at + side + 2, at, at + side + 2, at + side + 1]);
                }
            }
            let layout = Layout { uvs: &uvs, vertex_of_corner: &vertex_of_corner };
            let triangles: Vec<Triangle> = (0..layout.len()).map(|number| layout.triangle(number)).collect();
            let has_area = |i: usize| doubled_area(&triangles[i]) != 0.0;
            let meets = |i: usize| {
                (0..layout.len()).any(|j| i != j && has_area(j) && share_area(&triangles[i], &triangles[j]))
            };
            let expected: Vec<usize> = (0..layout.len()).filter(|&i| has_area(i) && meets(i)).collect();
            assert_eq!(overlapping(&uvs, &vertex_of_corner).triangles, expected, "seed {seed}");
        }
    }

    /// Stacks are found at once, and a fan of slivers stops the search: in a time that grows with the number
    /// of triangles, not with its square.
    #[test]
    fn large_inputs_take_bounded_time() {
        let stack: Vec<[f32; 2]> = (0..3_000).flat_map(|i| moved(CORNER, [1e-6 * i as f32, 0.0])).collect();
        assert_eq!(found(&stack).len(), 3_000);
        let around = |i: usize| {
            let (sin, cos) = (i as f32 / 8_000.0).sin_cos();
            [cos, sin]
        };
        let fan: Vec<[f32; 2]> = (0..8_000).flat_map(|i| [[0.0, 0.0], around(i), around(i + 1)]).collect();
        let found = overlapping(&fan, &in_order(&fan));
        assert!(found.triangles.is_empty() && !found.is_complete);
        // The fourth triangle needs the fourth to the sixth test at least; it and all others are left out.
        let vertex_of_corner = in_order(&fan);
        let layout = Layout { uvs: &fan, vertex_of_corner: &vertex_of_corner };
        let mut search = Search::new(&layout);
        search.tests_left = 5;
        let added = (0..8_000).map_while(|number| search.add(0, number)).count();
        assert_eq!((added, search.tests_left), (3, 0));
    }
}

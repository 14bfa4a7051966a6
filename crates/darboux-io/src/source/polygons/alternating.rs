//! Cuts a face as Blender does (its `BLI_polyfill_calc`), so that n-gons have the triangles that its
//! exporters write.
//!
//! Facts about that program, found in its source and confirmed with Blender 5.0 (docs/formats.md):
//!
//! - The face is seen along its normal (M. E. Newell's), with the first axis at right angles to it and to z.
//!   All of this is in single precision.
//! - Ears are cut off as long as more than three corners remain. The search for an ear begins two corners
//!   after the last one, so that a round face does not become a fan. Where that corner is not convex, the
//!   search begins one further, and its direction is reversed from then on.
//! - While no corner is reflex or straight, every corner is an ear. Else an ear is convex and holds no corner
//!   that is not convex, on its border included. If there is none, straight corners are taken, then any that
//!   is not reflex, then the corner where the search begins.
//!
//! Where many corners are not convex, a [tree](super::corner_tree) of them finds one in an ear. The side of
//! a line is decided in single precision for every corner that the tree cannot exclude by more than the
//! rounding errors of that decision, so the triangles are those of a test of all corners.

use darboux::internal::vectors::single::dot;

use super::corner_tree::CornerTree;
use super::triangle::Triangle;

/// The number of obstacles from which on a tree finds one in an ear: fewer are tested sooner one by one.
const MANY: usize = 32;

/// The side to which the face turns at a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turn {
    Convex,
    Straight,
    Reflex,
}

/// The triangles of a face. None: the steps are used up.
pub fn cut(positions: &[[f32; 3]], steps: &mut u64) -> Option<Vec<Triangle>> {
    cut_with(positions, MANY, steps)
}

/// As [`cut`]. `many`: the number of obstacles from which on a tree finds one in an ear.
fn cut_with(positions: &[[f32; 3]], many: usize, steps: &mut u64) -> Option<Vec<Triangle>> {
    let corners = projected(positions);
    let places: Vec<[f64; 2]> = corners.iter().map(|corner| corner.map(f64::from)).collect();
    let mut outline = Outline::new(corners, &places, many);
    let mut triangles = Vec::with_capacity(positions.len() - 2);
    let (mut start, mut backwards) = (0, false);
    while outline.remaining > 3 {
        let ear = outline.find_ear(start, backwards, steps)?;
        let [previous, next] = [outline.previous[ear], outline.next[ear]];
        triangles.push([previous, ear, next]);
        outline.remove(ear);
        outline.renew(previous);
        outline.renew(next);
        start = outline.step(if backwards { previous } else { next }, backwards);
        if outline.turns[start] != Turn::Convex {
            start = outline.step(start, backwards);
            backwards = !backwards;
        }
    }
    let first = outline.first;
    let second = outline.next[first];
    triangles.push([first, second, outline.next[second]]);
    Some(triangles)
}

/// The corners that are left, in a ring.
struct Outline<'a> {
    corners: Vec<[f32; 2]>,
    /// The corners in double precision.
    places: &'a [[f64; 2]],
    many: usize,
    next: Vec<usize>,
    previous: Vec<usize>,
    turns: Vec<Turn>,
    /// The corners that were not convex at first. Corners that were removed or became convex are skipped.
    obstacles: Vec<usize>,
    /// The obstacles, if there are many.
    tree: Option<CornerTree<'a>>,
    /// With a tree: the neighbours of a corner when it was last tried, and the obstacle in the triangle.
    last_obstacle: Vec<Option<([usize; 2], usize)>>,
    is_removed: Vec<bool>,
    /// The number of corners left that are not convex.
    not_convex: usize,
    remaining: usize,
    first: usize,
}

impl<'a> Outline<'a> {
    fn new(corners: Vec<[f32; 2]>, places: &'a [[f64; 2]], many: usize) -> Self {
        let count = corners.len();
        let mut outline = Self {
            corners,
            places,
            many,
            next: (0..count).map(|corner| (corner + 1) % count).collect(),
            previous: (0..count).map(|corner| (corner + count - 1) % count).collect(),
            turns: vec![Turn::Convex; count],
            obstacles: Vec::new(),
            tree: None,
            last_obstacle: Vec::new(),
            is_removed: vec![false; count],
            not_convex: 0,
            remaining: count,
            first: 0,
        };
        for corner in 0..count {
            outline.turns[corner] = outline.turn(corner);
        }
        outline.obstacles = (0..count).filter(|&corner| outline.turns[corner] != Turn::Convex).collect();
        outline.not_convex = outline.obstacles.len();
        outline.rebuild_tree();
        if outline.tree.is_some() {
            outline.last_obstacle = vec![None; count];
        }
        outline
    }

    /// Makes the tree of the obstacles.
    fn rebuild_tree(&mut self) {
        let obstacles = || self.obstacles.iter().map(|&corner| corner as u32).collect();
        self.tree =
            (self.obstacles.len() >= self.many).then(|| CornerTree::of_some(self.places, obstacles()));
    }

    /// Takes a corner out of the tree.
    fn remove_from_tree(&mut self, corner: usize) {
        if let Some(tree) = &mut self.tree {
            tree.remove(corner);
        }
    }

    fn turn(&self, corner: usize) -> Turn {
        side([self.previous[corner], corner, self.next[corner]].map(|corner| self.corners[corner]))
    }

    fn step(&self, corner: usize, backwards: bool) -> usize {
        if backwards { self.previous[corner] } else { self.next[corner] }
    }

    fn remove(&mut self, corner: usize) {
        let [previous, next] = [self.previous[corner], self.next[corner]];
        self.next[previous] = next;
        self.previous[next] = previous;
        self.is_removed[corner] = true;
        self.not_convex -= usize::from(self.turns[corner] != Turn::Convex);
        self.remaining -= 1;
        self.remove_from_tree(corner);
        if self.first == corner {
            self.first = next;
        }
    }

    /// Recomputes the turn of a neighbour of a removed corner. Convex ones stay as they are.
    fn renew(&mut self, corner: usize) {
        if self.turns[corner] != Turn::Convex {
            self.turns[corner] = self.turn(corner);
            if self.turns[corner] == Turn::Convex {
                self.not_convex -= 1;
                self.remove_from_tree(corner);
            }
        }
    }

    /// The next ear from a corner on. None: the steps are used up.
    fn find_ear(&mut self, start: usize, backwards: bool, steps: &mut u64) -> Option<usize> {
        for accepted in [Turn::Convex, Turn::Straight] {
            let mut corner = start;
            for _ in 0..self.remaining {
                *steps = steps.checked_sub(1)?;
                if self.is_ear(corner, accepted, steps)? {
                    return Some(corner);
                }
                corner = self.step(corner, backwards);
            }
        }
        let mut corner = start;
        for _ in 0..self.remaining {
            if self.turns[corner] != Turn::Reflex {
                return Some(corner);
            }
            corner = self.next[corner];
        }
        Some(corner)
    }

    fn is_ear(&mut self, corner: usize, accepted: Turn, steps: &mut u64) -> Option<bool> {
        if self.not_convex == 0 {
            return Some(true);
        }
        if self.turns[corner] != accepted {
            return Some(false);
        }
        if self.obstacles.len() > 2 * self.not_convex {
            let (is_removed, turns) = (&self.is_removed, &self.turns);
            self.obstacles.retain(|&corner| !is_removed[corner] && turns[corner] != Turn::Convex);
            self.rebuild_tree();
        }
        let triangle = [corner, self.next[corner], self.previous[corner]];
        match &self.tree {
            Some(tree) => {
                let neighbours = [triangle[1], triangle[2]];
                let is_known = |&(of, obstacle): &([usize; 2], usize)| of == neighbours && tree.has(obstacle);
                if self.last_obstacle[corner].as_ref().is_some_and(is_known) {
                    return Some(false);
                }
                let found = self.find_obstacle(tree, triangle, steps)?;
                self.last_obstacle[corner] = found.map(|obstacle| (neighbours, obstacle));
                Some(found.is_none())
            }
            None => {
                *steps = steps.checked_sub(self.obstacles.len() as u64)?;
                let lies_inside = |&obstacle: &usize| {
                    self.turns[obstacle] != Turn::Convex
                        && !self.is_removed[obstacle]
                        && self.lies_inside(obstacle, triangle)
                };
                Some(!self.obstacles.iter().any(lies_inside))
            }
        }
    }

    fn lies_inside(&self, obstacle: usize, triangle: Triangle) -> bool {
        let [a, b, c] = triangle.map(|corner| self.corners[corner]);
        let place = self.corners[obstacle];
        !triangle.contains(&obstacle)
            && [[a, b], [b, c], [c, a]].iter().all(|&[from, to]| side([from, to, place]) != Turn::Reflex)
    }

    /// The outer none: the steps are used up.
    #[expect(clippy::option_option, reason = "the outer one is the limit's")]
    fn find_obstacle(
        &self,
        tree: &CornerTree<'_>,
        triangle: Triangle,
        steps: &mut u64,
    ) -> Option<Option<usize>> {
        let [a, b, c] = triangle.map(|corner| self.places[corner]);
        let edges = [[a, b], [b, c], [c, a]];
        let may_hold = |bounds| !edges.iter().any(|&edge| is_all_reflex(bounds, edge));
        let before = *steps;
        let found = tree.find(may_hold, |obstacle| self.lies_inside(obstacle, triangle), steps)?;
        // A node takes longer than a test of one obstacle, and there are less than half as many.
        *steps = steps.checked_sub(before - *steps)?;
        Some(found)
    }
}

/// Whether [`side`] is reflex for every place between the least and the greatest coordinates.
///
/// The area that it computes is off by at most 2^-21 times the product of the greatest differences (four
/// roundings of two products), and by what products lose that are below the range of normal numbers.
fn is_all_reflex([least, greatest]: [[f64; 2]; 2], [a, b]: [[f64; 2]; 2]) -> bool {
    let x = if b[1] > a[1] { greatest[0] } else { least[0] };
    let y = if a[0] > b[0] { greatest[1] } else { least[1] };
    let area = (b[0] - x) * (a[1] - y) - (a[0] - x) * (b[1] - y);
    let difference = |i: usize| {
        let ends = [a[i] - least[i], a[i] - greatest[i], b[i] - least[i], b[i] - greatest[i]];
        ends.iter().fold(0.0f64, |most, end| most.max(end.abs()))
    };
    let [x, y] = [0, 1].map(difference);
    let product = x * y;
    // Beyond the range of single precision, differences of infinities would be no numbers.
    x < 1e37 && y < 1e37 && product < 1e37 && area + product * f64::from(f32::EPSILON) * 8.0 + 1e-40 < 0.0
}

/// The side of the line from a to b on which c lies: convex is to the right, as the projection mirrors the
/// face.
fn side([a, b, c]: [[f32; 2]; 3]) -> Turn {
    let [to_b, to_a] = [b, a].map(|p| [p[0] - c[0], p[1] - c[1]]);
    let area = to_b[0] * to_a[1] - to_a[0] * to_b[1];
    if area > 0.0 {
        Turn::Convex
    } else if area == 0.0 {
        Turn::Straight
    } else {
        Turn::Reflex
    }
}

/// The corners as seen against the normal of the face.
fn projected(positions: &[[f32; 3]]) -> Vec<[f32; 2]> {
    let [x, y, z] = normal(positions).map(|component| -component);
    let flat = x * x + y * y;
    let (first, second) = if flat > f32::EPSILON {
        let d = 1.0 / flat.sqrt();
        let first = [y * d, -x * d, 0.0];
        (first, [-z * first[1], z * first[0], x * first[1] - y * first[0]])
    } else {
        ([if z < 0.0 { -1.0 } else { 1.0 }, 0.0, 0.0], [0.0, 1.0, 0.0])
    };
    positions.iter().map(|&position| [dot(first, position), dot(second, position)]).collect()
}

/// The unit normal of a face; z where it has no area.
fn normal(positions: &[[f32; 3]]) -> [f32; 3] {
    let last = positions[positions.len() - 1];
    let (sum, _) = positions.iter().fold(([0.0f32; 3], last), |(sum, before), &at| {
        let next = [0, 1, 2].map(|i| {
            let [j, k] = [(i + 1) % 3, (i + 2) % 3];
            sum[i] + (before[j] - at[j]) * (before[k] + at[k])
        });
        (next, at)
    });
    let squared = dot(sum, sum);
    if squared > 1.0e-35 { sum.map(|x| x * (1.0 / squared.sqrt())) } else { [0.0, 0.0, 1.0] }
}

#[cfg(test)]
mod tests {
    use darboux_dice::Dice;

    use super::*;

    /// Faces of random corners, whose triangles must be those without a tree.
    #[test]
    fn a_tree_changes_no_triangle() {
        let mut dice = Dice::from_seed(47);
        for round in 0..120 {
            let (count, places) = (100 + dice.below(300), [6, 40, 4000][round % 3]);
            let scale = [1.0f32, 1e-22, 1e17, 1e-3][round % 4];
            let mut positions: Vec<[f32; 3]> = (0..count)
                .map(|_| [0, 1, 2].map(|_| (dice.below(places) as f32 * 0.1 + 7.0) * scale))
                .collect();
            if round.is_multiple_of(2) {
                let middle = 0.05 * places as f32 + 7.0;
                let angle = |p: &[f32; 3]| (p[1] / scale - middle).atan2(p[0] / scale - middle);
                positions.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
                positions.iter_mut().for_each(|position| position[2] = 0.0);
            }
            let slow = cut_with(&positions, usize::MAX, &mut (1 << 40)).expect("enough steps");
            let mut steps = 1 << 40;
            assert_eq!(cut_with(&positions, 1, &mut steps).expect("enough steps"), slow, "round {round}");
        }
    }
}

//! A tree over the corners of a polygon that finds a corner in a triangle (J. L. Bentley, "Multidimensional
//! Binary Search Trees Used for Associative Searching", 1975), with boxes. Corners can be removed.
//!
//! A box is passed over where the test of the triangle's edges fails for every place in it. That bound is
//! computed by the operations of the test itself at the ends of the box. Rounding is monotone, so the answer
//! is the same as that of a test of all corners.

/// The most corners in a leaf.
const LEAF: usize = 8;

/// Twice the area of a triangle, negative if it is clockwise.
pub fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The corners that were not removed.
pub struct CornerTree<'a> {
    corners: &'a [[f64; 2]],
    /// The corners; the corners of a node lie side by side.
    order: Vec<u32>,
    /// The nodes as a complete binary tree: the children of node n are 2 n + 1 and 2 n + 2.
    nodes: Vec<Node>,
    /// The leaf of each corner; none for corners that were removed.
    leaf_of_corner: Vec<Option<u32>>,
}

#[derive(Clone, Copy)]
struct Node {
    least: [f64; 2],
    greatest: [f64; 2],
    /// The place of the node's corners in the order.
    first: u32,
    end: u32,
    /// How many of them were not removed.
    remaining: u32,
}

impl<'a> CornerTree<'a> {
    pub fn new(corners: &'a [[f64; 2]]) -> Self {
        Self::of_some(corners, (0..corners.len() as u32).collect())
    }

    /// As [`CornerTree::new`], where only some corners were not removed.
    pub fn of_some(corners: &'a [[f64; 2]], some: Vec<u32>) -> Self {
        let count = some.len();
        let leaves = count.div_ceil(LEAF).next_power_of_two();
        let absent = Node { least: [0.0; 2], greatest: [0.0; 2], first: 0, end: 0, remaining: 0 };
        let mut tree = Self {
            corners,
            order: some,
            nodes: vec![absent; 2 * leaves - 1],
            leaf_of_corner: vec![None; corners.len()],
        };
        tree.build(0, 0, count);
        tree
    }

    fn build(&mut self, node: usize, first: usize, end: usize) {
        let infinite = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let (least, greatest) = self.order[first..end].iter().fold(infinite, |(least, greatest), &corner| {
            let corner = self.corners[corner as usize];
            ([0, 1].map(|i| corner[i].min(least[i])), [0, 1].map(|i| corner[i].max(greatest[i])))
        });
        let remaining = (end - first) as u32;
        self.nodes[node] = Node { least, greatest, first: first as u32, end: end as u32, remaining };
        if self.is_leaf(node) {
            for &corner in &self.order[first..end] {
                self.leaf_of_corner[corner as usize] = Some(node as u32);
            }
            return;
        }
        let axis = usize::from(greatest[1] - least[1] > greatest[0] - least[0]);
        let middle = first + (end - first) / 2;
        if end > first {
            let key = |corner: u32| (self.corners[corner as usize][axis], corner);
            let order = |a: &u32, b: &u32| key(*a).0.total_cmp(&key(*b).0).then(a.cmp(b));
            self.order[first..end].select_nth_unstable_by(middle - first, order);
        }
        self.build(2 * node + 1, first, middle);
        self.build(2 * node + 2, middle, end);
    }

    fn is_leaf(&self, node: usize) -> bool {
        2 * node + 1 >= self.nodes.len()
    }

    /// Whether a corner was not removed.
    pub fn has(&self, corner: usize) -> bool {
        self.leaf_of_corner[corner].is_some()
    }

    pub fn remove(&mut self, corner: usize) {
        let Some(leaf) = self.leaf_of_corner[corner].take() else { return };
        let mut node = leaf as usize;
        loop {
            self.nodes[node].remaining -= 1;
            if node == 0 {
                return;
            }
            node = (node - 1) / 2;
        }
    }

    /// A corner that lies in a triangle of corners or on its border. Corners at the places of the triangle's
    /// own are allowed: they join outlines and holes. The outer none: the steps are used up.
    #[expect(clippy::option_option, reason = "the outer one is the limit's")]
    pub fn corner_in(&self, triangle: [usize; 3], steps: &mut u64) -> Option<Option<usize>> {
        let own = triangle.map(|corner| self.corners[corner]);
        let [a, b, c] = own;
        let edges = [[a, b], [b, c], [c, a]];
        let may_hold = |[least, greatest]: [[f64; 2]; 2]| {
            let is_own = least == greatest && own.contains(&least);
            !is_own && !edges.iter().any(|&edge| lies_outside([least, greatest], edge))
        };
        let is_inside = |corner: usize| {
            let place = self.corners[corner];
            !own.contains(&place) && edges.iter().all(|&[from, to]| area([from, to, place]) >= 0.0)
        };
        self.find(may_hold, is_inside, steps)
    }

    /// A corner that `is_wanted`. `may_hold`: whether one can lie between the least and the greatest
    /// coordinates of a box. The outer none: the steps are used up.
    #[expect(clippy::option_option, reason = "the outer one is the limit's")]
    pub fn find(
        &self,
        may_hold: impl Fn([[f64; 2]; 2]) -> bool,
        is_wanted: impl Fn(usize) -> bool,
        steps: &mut u64,
    ) -> Option<Option<usize>> {
        let mut waiting = vec![0];
        while let Some(node) = waiting.pop() {
            *steps = steps.checked_sub(1)?;
            let Node { least, greatest, first, end, remaining } = self.nodes[node];
            if remaining == 0 || !may_hold([least, greatest]) {
                continue;
            }
            if !self.is_leaf(node) {
                waiting.extend([2 * node + 1, 2 * node + 2]);
                continue;
            }
            let mut corners = self.order[first as usize..end as usize].iter().map(|&corner| corner as usize);
            if let Some(found) = corners.find(|&corner| self.has(corner) && is_wanted(corner)) {
                return Some(Some(found));
            }
        }
        Some(None)
    }
}

/// Whether all places of a box lie to the right of an edge.
fn lies_outside([least, greatest]: [[f64; 2]; 2], [from, to]: [[f64; 2]; 2]) -> bool {
    let x = if to[1] > from[1] { least[0] } else { greatest[0] };
    let y = if to[0] > from[0] { greatest[1] } else { least[1] };
    area([from, to, [x, y]]) < 0.0
}

#[cfg(test)]
mod tests {
    use darboux_dice::Dice;

    use super::*;

    #[test]
    fn the_answer_is_that_of_a_test_of_all_corners() {
        let mut dice = Dice::from_seed(29);
        let mut found = 0;
        for round in 0..200 {
            // Few different places make corners coincide and lie on edges.
            let places = [4, 30, 1000][round % 3];
            let count = 3 + dice.below(150);
            let corners: Vec<[f64; 2]> =
                (0..count).map(|_| [0, 1].map(|_| f64::from(dice.below(places) as f32 * 0.1))).collect();
            let mut tree = CornerTree::new(&corners);
            let mut alive = vec![true; count];
            for _ in 0..20 {
                let removed = dice.below(count);
                tree.remove(removed);
                alive[removed] = false;
                let triangle = [0, 1, 2].map(|_| dice.below(count));
                let own = triangle.map(|corner| corners[corner]);
                let is_inside = |corner: &usize| {
                    let sides =
                        [[0, 1], [1, 2], [2, 0]].map(|[i, j]| area([own[i], own[j], corners[*corner]]));
                    alive[*corner]
                        && !own.contains(&corners[*corner])
                        && sides.iter().all(|&side| side >= 0.0)
                };
                let expected = (0..count).any(|corner| is_inside(&corner));
                let answer = tree.corner_in(triangle, &mut 10_000).expect("enough steps");
                assert_eq!(answer.is_some(), expected, "{own:?}");
                assert!(answer.is_none_or(|corner| is_inside(&corner)));
                found += usize::from(expected);
            }
        }
        assert!(found > 100, "{found} corners");
    }
}

//! Cuts a face into ears in another order than [`Polygon::ears`](super::ears::Polygon::ears), which takes few
//! steps for faces of any shape: a corner that is no ear is tried again when the obstacle in its triangle is
//! cut off or one of its neighbours changes, not before. Neighbours of an ear go to the end of the queue, so
//! that ears of about one size are cut in turn.

use std::collections::VecDeque;

use super::corner_tree::{CornerTree, area};
use super::triangle::Triangle;

/// The triangles of a face. `corners`: counter-clockwise.
///
/// None: no ear is left, because the face crosses itself, or the steps are used up.
pub fn cut(corners: &[[f64; 2]], steps: &mut u64) -> Option<Vec<Triangle>> {
    let mut face = Face::new(corners);
    let mut triangles = Vec::with_capacity(corners.len() - 2);
    while triangles.len() + 3 < corners.len() {
        *steps = steps.checked_sub(1)?;
        let Some((corner, turn)) = face.queue.pop_front() else {
            // Only empty triangles and crossing edges are left.
            let empty = face.empty_ear(steps)?;
            triangles.push(face.triangle(empty));
            face.cut_off(empty);
            continue;
        };
        if face.turns[corner] != turn || face.is_cut_off[corner] {
            continue;
        }
        let ear = face.triangle(corner);
        if face.area(ear) <= 0.0 {
            continue;
        }
        match face.obstacles.corner_in(ear, steps)? {
            Some(obstacle) => face.waiting[obstacle].push((corner, turn)),
            None => {
                triangles.push(ear);
                face.cut_off(corner);
            }
        }
    }
    triangles.push(face.triangle(face.first));
    Some(triangles)
}

/// The corners that are left, in a ring, and those that wait to be tried.
struct Face<'a> {
    corners: &'a [[f64; 2]],
    next: Vec<usize>,
    previous: Vec<usize>,
    is_cut_off: Vec<bool>,
    /// The corners that are not convex, which alone can lie in ears.
    obstacles: CornerTree<'a>,
    /// Corners to try, each with its turn. Corners with an earlier turn are skipped.
    queue: VecDeque<(usize, u32)>,
    turns: Vec<u32>,
    /// By the obstacle, the corners in whose triangles it lies, each with the turn of that triangle.
    waiting: Vec<Vec<(usize, u32)>>,
    /// A corner that is left.
    first: usize,
}

impl<'a> Face<'a> {
    fn new(corners: &'a [[f64; 2]]) -> Self {
        let count = corners.len();
        let [next, previous] = [1, count - 1].map(|step| (0..count).map(|at| (at + step) % count).collect());
        let mut face = Self {
            corners,
            next,
            previous,
            is_cut_off: vec![false; count],
            obstacles: CornerTree::of_some(corners, Vec::new()),
            // Every second corner first, as an ear changes its neighbours.
            queue: (0..count).step_by(2).chain((1..count).step_by(2)).map(|corner| (corner, 0)).collect(),
            turns: vec![0; count],
            waiting: vec![Vec::new(); count],
            first: 0,
        };
        let is_obstacle = |&corner: &usize| face.area(face.triangle(corner)) <= 0.0;
        let obstacles = (0..count).filter(is_obstacle).map(|corner| corner as u32).collect();
        face.obstacles = CornerTree::of_some(corners, obstacles);
        face
    }

    /// A corner between its neighbours.
    fn triangle(&self, corner: usize) -> Triangle {
        [self.previous[corner], corner, self.next[corner]]
    }

    fn area(&self, triangle: Triangle) -> f64 {
        area(triangle.map(|corner| self.corners[corner]))
    }

    /// Removes a corner, and lets those be tried for which that may change something.
    fn cut_off(&mut self, corner: usize) {
        let [before, _, after] = self.triangle(corner);
        (self.next[before], self.previous[after]) = (after, before);
        self.is_cut_off[corner] = true;
        self.first = after;
        for neighbour in [before, after] {
            self.turns[neighbour] += 1;
            self.queue.push_back((neighbour, self.turns[neighbour]));
            if self.obstacles.has(neighbour) && self.area(self.triangle(neighbour)) > 0.0 {
                self.remove_obstacle(neighbour);
            }
        }
        self.remove_obstacle(corner);
    }

    fn remove_obstacle(&mut self, obstacle: usize) {
        self.obstacles.remove(obstacle);
        self.queue.extend(std::mem::take(&mut self.waiting[obstacle]));
    }

    /// A corner on a straight line between its neighbours. None: there is none, or the steps are used up.
    fn empty_ear(&self, steps: &mut u64) -> Option<usize> {
        let mut corner = self.first;
        loop {
            *steps = steps.checked_sub(1)?;
            if self.area(self.triangle(corner)) == 0.0 {
                return Some(corner);
            }
            corner = self.next[corner];
            if corner == self.first {
                return None;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use darboux_dice::Dice;

    use super::*;

    /// Cuts a face into as many triangles as it has, none of which may be clockwise. The areas of ears add up
    /// to the face's area, so the ears then cover the face once. Returns the number of steps.
    fn covering(corners: &[[f64; 2]]) -> u64 {
        let mut steps = 1 << 30;
        let triangles = cut(corners, &mut steps).expect("the face has ears");
        let of = |triangle: Triangle| area(triangle.map(|corner| corners[corner]));
        assert_eq!(triangles.len(), corners.len() - 2);
        assert!(triangles.iter().all(|&triangle| of(triangle) >= 0.0));
        (1 << 30) - steps
    }

    fn ring(corners: usize, distance: impl Fn(usize) -> f64) -> Vec<[f64; 2]> {
        let at = |i: usize| {
            let (angle, distance) = (TAU * i as f64 / corners as f64, distance(i));
            [distance * angle.cos(), distance * angle.sin()].map(|x| f64::from(x as f32))
        };
        (0..corners).map(at).collect()
    }

    /// A band between two spirals of six turns.
    fn spiral(corners: usize) -> Vec<[f64; 2]> {
        let half = corners / 2;
        let at = |i: usize, inset: f64| {
            let angle = 6.0 * TAU * i as f64 / half as f64;
            let distance = 4.0 + angle - inset;
            [distance * angle.cos(), distance * angle.sin()].map(|x| f64::from(x as f32))
        };
        (0..half).map(|i| at(i, 0.0)).chain((0..half).rev().map(|i| at(i, 3.0))).collect()
    }

    /// Teeth of random depths on a bar.
    fn comb(corners: usize, dice: &mut Dice) -> Vec<[f64; 2]> {
        let tooth = |i: usize| [i as f64, if i.is_multiple_of(2) { 1000.0 } else { dice.below(900) as f64 }];
        let mut comb: Vec<[f64; 2]> = (0..corners - 2).map(tooth).collect();
        comb.reverse();
        comb.extend([[-1.0, -1.0], [corners as f64, -1.0]]);
        comb
    }

    /// A half circle of reflex corners before two that are far from it.
    fn arch(corners: usize) -> Vec<[f64; 2]> {
        let at = |i: usize| {
            let (sin, cos) = (0.5 * TAU * i as f64 / (corners - 2) as f64).sin_cos();
            [3.0 * sin, cos].map(|x| f64::from(x as f32))
        };
        [[10.0, -1.0], [10.0, 1.0]].into_iter().chain((0..corners - 2).map(at)).collect()
    }

    /// H. von Koch's curve, in single precision, of at most so many corners.
    fn koch(corners: usize) -> Vec<[f64; 2]> {
        let mut curve = ring(3, |_| 1.0);
        while 4 * curve.len() <= corners {
            let ends = curve.iter().zip(curve.iter().cycle().skip(1));
            let parts = ends.flat_map(|(&[x, y], &[end_x, end_y])| {
                let [dx, dy] = [(end_x - x) / 3.0, (end_y - y) / 3.0];
                let height = 0.75f64.sqrt();
                let top = [x + 1.5 * dx + height * dy, y + 1.5 * dy - height * dx];
                [[x, y], [x + dx, y + dy], top, [x + 2.0 * dx, y + 2.0 * dy]]
            });
            curve = parts.collect();
        }
        curve.into_iter().map(|corner| corner.map(|x| f64::from(x as f32))).collect()
    }

    #[test]
    fn faces_of_all_shapes_take_steps_in_proportion_to_their_corners() {
        let mut dice = Dice::from_seed(5);
        for corners in [1000, 30_000] {
            let depths: Vec<f64> = (0..corners).map(|_| 0.3 + 0.001 * dice.below(700) as f64).collect();
            let faces = [
                ("round", ring(corners, |_| 1.0)),
                ("star", ring(corners, |i| [1.0, 0.3][i % 2])),
                ("jagged", ring(corners, |i| depths[i])),
                ("spiral", spiral(corners)),
                ("comb", comb(corners, &mut dice)),
                ("arch", arch(corners)),
                ("Koch curve", koch(corners)),
            ];
            for (name, face) in faces {
                let steps = covering(&face);
                assert!(steps < 400 * corners as u64, "{name} of {corners} corners: {steps} steps");
            }
        }
    }

    #[test]
    fn corners_on_straight_lines_are_cut_last() {
        covering(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0], [0.0, 1.0]]);
    }

    #[test]
    fn a_face_that_crosses_itself_has_no_ears_at_last() {
        // A loop at whose crossing a clockwise one begins.
        let bow = [[-4.0, 4.0], [-4.0, -4.0], [1.0, 1.0], [2.0, 1.0], [2.0, -1.0], [1.0, -1.0]];
        let mut steps = 1000;
        assert_eq!(cut(&bow, &mut steps), None);
        assert!(steps > 900, "{steps} steps are left");
    }

    #[test]
    fn steps_are_limited() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.5]];
        assert!(cut(&square, &mut 100).is_some());
        assert_eq!(cut(&square, &mut 3), None);
    }

    /// A corner waits for an obstacle in its triangle. Once a neighbour has changed, that wait is outdated.
    #[test]
    fn outdated_waits_are_passed_over() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]];
        let mut face = Face::new(&corners);
        face.waiting[3].push((0, face.turns[0]));
        face.cut_off(4);
        face.queue.clear();
        face.remove_obstacle(3);
        assert!(face.queue.iter().all(|&(corner, turn)| face.turns[corner] != turn), "{:?}", face.queue);
        assert_eq!(face.queue.len(), 1);
    }
}

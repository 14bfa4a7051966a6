//! Cuts faces into ears (G. H. Meisters, "Polygons Have Ears", 1975).
//!
//! The face is seen along the axis along which it looks largest, by its normal (M. E. Newell: the sum of the
//! edges' areas per plane). Coordinates are compared without the one along the axis, not rotated: products of
//! 32-bit numbers are then nearly exact in 64 bits. Whether a corner lies in an ear is asked of a tree of the
//! corners ([`corner_tree`](super::corner_tree)), not of every corner.

use super::corner_tree::{CornerTree, area};
use super::queued;
use super::triangle::Triangle;

/// A face as seen along an axis, counter-clockwise.
pub struct Polygon {
    corners: Vec<[f64; 2]>,
}

impl Polygon {
    /// None: the face has no area, or coordinates that are not finite.
    pub fn of(positions: &[[f64; 3]]) -> Option<Self> {
        let normal = newell_normal(positions);
        let axis = (0..3).max_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs()))?;
        if normal[axis] == 0.0 || !normal.iter().all(|x| x.is_finite()) {
            return None;
        }
        let [x, y] = [(axis + 1) % 3, (axis + 2) % 3];
        let [x, y] = if normal[axis] > 0.0 { [x, y] } else { [y, x] };
        Some(Self { corners: positions.iter().map(|p| [p[x], p[y]]).collect() })
    }

    /// Twice the area of a triangle, negative if it is clockwise.
    fn area(&self, [a, b, c]: Triangle) -> f64 {
        area([a, b, c].map(|corner| self.corners[corner]))
    }

    /// The number of triangles that are folded or empty.
    pub fn faults(&self, triangles: &[Triangle]) -> usize {
        triangles.iter().filter(|&&triangle| self.area(triangle) <= 0.0).count()
    }

    /// Whether a triangle faces the other way than the face.
    pub fn is_folded(&self, triangles: &[Triangle]) -> bool {
        triangles.iter().any(|&triangle| self.area(triangle) < 0.0)
    }

    /// The fan if all its triangles face as the face does, as in convex faces; else ears, if fewer of them
    /// are folded or empty.
    pub fn cut(&self, fan: Vec<Triangle>, steps: &mut u64) -> Vec<Triangle> {
        let faults = self.faults(&fan);
        let ears = if faults > 0 { self.ears(steps) } else { None };
        ears.filter(|ears| self.faults(ears) < faults).unwrap_or(fan)
    }

    /// As [`Polygon::ears`], in an order that takes few steps.
    pub fn queued(&self, steps: &mut u64) -> Option<Vec<Triangle>> {
        queued::cut(&self.corners, steps)
    }

    /// Cuts off ears: triangles of neighbours that contain no other corner. Corners on a straight line are
    /// kept for other ears while there are any.
    ///
    /// None: no ear is left, because the face crosses itself, or the steps are used up.
    pub fn ears(&self, steps: &mut u64) -> Option<Vec<Triangle>> {
        let count = self.corners.len();
        let mut ring = Ring::new(count);
        let mut tree = CornerTree::new(&self.corners);
        // The corner that lay in the triangle of a corner when it was last tried, and that triangle.
        let mut obstacles: Vec<Option<(Triangle, usize)>> = vec![None; count];
        let mut triangles = Vec::with_capacity(count - 2);
        let (mut at, mut tried, mut takes_empty) = (0, 0, false);
        while triangles.len() + 3 < count {
            *steps = steps.checked_sub(1)?;
            let ear = ring.triangle(at);
            let area = self.area(ear);
            let is_ear = match takes_empty {
                true => area == 0.0,
                false => {
                    let is_known =
                        obstacles[at].is_some_and(|(of, obstacle)| of == ear && tree.has(obstacle));
                    if area > 0.0 && !is_known {
                        obstacles[at] = tree.corner_in(ear, steps)?.map(|obstacle| (ear, obstacle));
                    }
                    area > 0.0 && obstacles[at].is_none()
                }
            };
            if is_ear {
                triangles.push(ear);
                ring.remove(at);
                tree.remove(at);
                (at, tried, takes_empty) = (ring.next[ring.next[at]], 0, false);
                continue;
            }
            (at, tried) = (ring.next[at], tried + 1);
            if tried == count - triangles.len() {
                if takes_empty {
                    return None;
                }
                (tried, takes_empty) = (0, true);
            }
        }
        triangles.push(ring.triangle(at));
        Some(triangles)
    }
}

/// The normal of a polygon: each component is twice the signed area that is seen along the axis.
fn newell_normal(positions: &[[f64; 3]]) -> [f64; 3] {
    let first = positions[0];
    let from_first = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] - first[i]);
    positions.windows(2).fold([0.0; 3], |sum, edge| {
        let [a, b] = [edge[0], edge[1]].map(from_first);
        [0, 1, 2].map(|i| {
            let [j, k] = [(i + 1) % 3, (i + 2) % 3];
            sum[i] + a[j] * b[k] - a[k] * b[j]
        })
    })
}

/// The corners that are not cut off, in a ring.
struct Ring {
    next: Vec<usize>,
    previous: Vec<usize>,
}

impl Ring {
    fn new(count: usize) -> Self {
        let next = (0..count).map(|corner| (corner + 1) % count).collect();
        let previous = (0..count).map(|corner| (corner + count - 1) % count).collect();
        Self { next, previous }
    }

    /// A corner between its neighbours.
    fn triangle(&self, corner: usize) -> Triangle {
        [self.previous[corner], corner, self.next[corner]]
    }

    fn remove(&mut self, corner: usize) {
        let [before, _, after] = self.triangle(corner);
        self.next[before] = after;
        self.previous[after] = before;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAX_STEPS: u64 = 1 << 26;

    /// The triangles of a face, as the rule `fan` makes them.
    struct Cut {
        triangles: Vec<Triangle>,
        is_folded: bool,
    }

    fn fan(corners: usize) -> impl Iterator<Item = Triangle> {
        (2..corners).map(|corner| [0, corner - 1, corner])
    }

    fn cut(positions: &[[f64; 3]], steps: &mut u64) -> Cut {
        let fan: Vec<Triangle> = fan(positions.len()).collect();
        let Some(polygon) = Polygon::of(positions) else { return Cut { triangles: fan, is_folded: false } };
        let triangles = polygon.cut(fan, steps);
        Cut { is_folded: polygon.is_folded(&triangles), triangles }
    }

    fn flat(corners: &[[f64; 2]]) -> Vec<[f64; 3]> {
        corners.iter().map(|&[x, y]| [x, y, 0.0]).collect()
    }

    /// The triangles of a face, which must cover it: there are as many as it has, and all face as it does.
    fn covering(positions: &[[f64; 3]]) -> Vec<Triangle> {
        let cut = cut(positions, &mut MAX_STEPS.clone());
        let polygon = Polygon::of(positions).expect("the face has an area");
        assert_eq!(cut.triangles.len(), positions.len() - 2);
        assert!(!cut.is_folded && polygon.faults(&cut.triangles) == 0, "{:?}", cut.triangles);
        cut.triangles
    }

    #[test]
    fn convex_faces_are_fans() {
        let round = |i: i32| {
            let angle = f64::from(i) * 0.7;
            [angle.cos(), angle.sin()]
        };
        let hexagon: Vec<[f64; 2]> = (0..8).map(round).collect();
        assert_eq!(covering(&flat(&hexagon)), fan(8).collect::<Vec<_>>());
        // The first corner sees all others, so the fan covers this concave face, too.
        let arrow = [[0.0, 1.0], [-2.0, -1.0], [0.0, 3.0], [2.0, -1.0]];
        let seen_from_inside = [arrow[0], arrow[3], arrow[2], arrow[1]];
        assert_eq!(covering(&flat(&seen_from_inside)), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn concave_faces_are_cut_into_ears() {
        // A quad whose fan would fold over: the other diagonal.
        let arrow = [[-2.0, -1.0], [0.0, 1.0], [2.0, -1.0], [0.0, 3.0]];
        assert_eq!(covering(&flat(&arrow)).len(), 2);
        // A comb with seven teeth, from every first corner, in both directions of view.
        let tooth = |i: i32| [[f64::from(i), 5.0], [f64::from(i) + 0.5, 1.0]];
        let mut comb: Vec<[f64; 2]> = (0..7).rev().flat_map(tooth).collect();
        comb.extend([[-1.0, 0.0], [8.0, 0.0]]);
        for first in 0..comb.len() {
            comb.rotate_left(1);
            covering(&flat(&comb));
            let seen_from_below: Vec<[f64; 3]> = comb.iter().rev().map(|&[x, y]| [0.3 * x, 2.0, y]).collect();
            assert_eq!(covering(&seen_from_below).len(), comb.len() - 2, "first corner {first}");
        }
    }

    #[test]
    fn corners_on_straight_lines_make_no_empty_triangles() {
        let square = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0], [0.0, 1.0]];
        for first in 0..square.len() {
            let mut square = square;
            square.rotate_left(first);
            covering(&flat(&square));
        }
    }

    #[test]
    fn a_hole_that_a_slit_joins_stays_open() {
        let outline = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
        let hole = [[1.0, 1.0], [1.0, 3.0], [3.0, 3.0], [3.0, 1.0], [1.0, 1.0]];
        let face = flat(&[&outline[..], &hole[..]].concat());
        let triangles = covering(&face);
        let middle = |triangle: &Triangle| {
            [0, 1].map(|i| triangle.map(|corner| face[corner][i]).iter().sum::<f64>() / 3.0)
        };
        let is_in_hole = |[x, y]: [f64; 2]| (1.01..2.99).contains(&x) && (1.01..2.99).contains(&y);
        assert!(!triangles.iter().any(|triangle| is_in_hole(middle(triangle))), "{triangles:?}");
    }

    #[test]
    fn faces_that_are_not_planar_are_cut_as_their_shadow() {
        let arrow = [[-2.0, -1.0, 0.3], [0.0, 1.0, -0.4], [2.0, -1.0, 0.2], [0.0, 3.0, 0.9]];
        let [first, second] = covering(&arrow)[..] else { panic!("two triangles") };
        assert!(first.contains(&1) && first.contains(&3) && second.contains(&1) && second.contains(&3));
    }

    #[test]
    fn faces_without_an_area_and_crossed_ones_stay_fans() {
        let whole = |positions: &[[f64; 3]]| cut(positions, &mut MAX_STEPS.clone());
        let line = whole(&flat(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0], [2.0, 2.0]]));
        assert!(!line.is_folded && line.triangles == [[0, 1, 2], [0, 2, 3]]);
        let broken = whole(&flat(&[[0.0, 0.0], [f64::NAN, 1.0], [3.0, 3.0], [2.0, 2.0]]));
        assert!(!broken.is_folded && broken.triangles == line.triangles);
        let bow = whole(&flat(&[[0.0, 0.0], [3.0, 3.0], [3.0, 0.0], [0.0, 2.0]]));
        assert!(bow.is_folded && bow.triangles == line.triangles);
        // A corner twice at one place: any cut has an empty triangle, so the fan stays.
        let doubled = whole(&flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]));
        assert!(!doubled.is_folded && doubled.triangles == line.triangles);
    }

    /// A star whose every second corner lies further inside, with radii that differ so that corners lie near
    /// ears.
    fn star(corners: usize) -> Vec<[f64; 3]> {
        let at = |i: usize| {
            let angle = std::f64::consts::TAU * i as f64 / corners as f64;
            let radius = if i.is_multiple_of(2) { 0.3 + 0.1 * (7.0 * angle).sin() } else { 1.0 };
            [radius * angle.cos(), radius * angle.sin(), 0.0].map(|x| f64::from(x as f32))
        };
        (0..corners).map(at).collect()
    }

    #[test]
    fn large_faces_take_steps_in_proportion_to_their_corners() {
        // Both the star and the same corner triple over and over, which crosses itself.
        let triple = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
        for corners in [3000, 24_000] {
            let used = |positions: &[[f64; 3]]| {
                let mut steps = MAX_STEPS;
                let cut = cut(positions, &mut steps);
                (cut, MAX_STEPS - steps)
            };
            let (cut, steps) = used(&star(corners));
            assert!(!cut.is_folded && steps < 200 * corners as u64, "{corners} corners: {steps} steps");
            let (_, steps) = used(&triple.repeat(corners / 3));
            assert!(steps < 200 * corners as u64, "{corners} corners of one triangle: {steps} steps");
        }
    }

    #[test]
    fn steps_are_limited() {
        let arrow = flat(&[[-2.0, -1.0], [0.0, 1.0], [2.0, -1.0], [0.0, 3.0]]);
        assert!(cut(&arrow, &mut 0).is_folded);
    }
}

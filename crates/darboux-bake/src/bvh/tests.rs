//! Hits against the slow twin: every triangle, in double precision.

use darboux::Context;
use darboux_dice::Dice;

use super::*;

type Triangle = [[f32; 3]; 3];

fn build(triangles: &[Triangle], threads: usize) -> Bvh {
    let mut context = Context::new();
    context.set_max_threads(threads);
    Bvh::build(triangles.len() as u32, &|id| triangles[id as usize], &context).expect("not cancelled")
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
    v.map(|x| x / length)
}

/// The slow twin: the distance at which a ray meets a triangle (T. Möller, B. Trumbore, 1997), and the least
/// barycentric coordinate there.
fn meet([a, b, c]: Triangle, ray: &Ray) -> Option<(f64, f64)> {
    let wide = |v: [f32; 3]| v.map(f64::from);
    let sub = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let cross = |p: [f64; 3], q: [f64; 3]| {
        [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
    };
    let (a, d) = (wide(a), wide(ray.direction));
    let (e, f) = (sub(wide(b), a), sub(wide(c), a));
    let volume = dot(e, cross(d, f));
    let from = sub(wide(ray.origin), a);
    let (u, v) = (dot(from, cross(d, f)) / volume, dot(d, cross(from, e)) / volume);
    let least = u.min(v).min(1.0 - u - v);
    (volume != 0.0).then(|| (dot(f, cross(from, e)) / volume, least))
}

/// Random triangles, some of them degenerate, and many with equal centres.
fn soup(dice: &mut Dice<'_>, count: usize) -> Vec<Triangle> {
    let size = dice.pick(&[0.02, 0.2, 2.0]);
    let mut triangle = || {
        let centre = [0, 1, 2].map(|_| dice.uniform());
        let mut corner = || [0, 1, 2].map(|i| centre[i] + size * dice.uniform());
        let corners = [corner(), corner(), corner()];
        if dice.one_in(20) { [corners[0]; 3] } else { corners }
    };
    let mut list: Vec<Triangle> = (0..count).map(|_| triangle()).collect();
    let copies = list[0];
    list.extend([copies; 30]);
    list
}

#[test]
fn hits_are_those_of_a_test_of_all_triangles() {
    let mut dice = Dice::from_seed(11);
    let mut stack = Stack::new();
    let (mut hits, mut near_edges) = (0, 0);
    for round in 0..40 {
        let triangles = soup(&mut dice, [3, 40, 700][round % 3]);
        let bvh = build(&triangles, 1);
        assert_eq!(bvh.triangle_count(), triangles.len());
        for _ in 0..200 {
            let ray = Ray {
                origin: [0, 1, 2].map(|_| 1.5 * dice.uniform()),
                direction: unit([0, 1, 2].map(|_| dice.uniform())),
                length: dice.pick(&[0.3, 4.0]),
            };
            let met = |triangle: &Triangle| meet(*triangle, &ray);
            let found = bvh.nearest(&ray, Sides::Both, &mut stack);
            assert_eq!(bvh.is_blocked(&ray, &mut stack), found.is_some());
            // Within 1e-4 of an edge or of the ends of the ray rounding may decide; the coordinates are below
            // 4 and floats have 7 digits.
            let all: Vec<(f64, f64)> = triangles.iter().filter_map(met).collect();
            let is_within = |t: f64, by: f64| t > by && t < f64::from(ray.length) - by;
            let expected = all.iter().filter(|(t, least)| *least > 1e-4 && is_within(*t, 1e-4));
            let expected = expected.map(|(t, _)| *t).fold(f64::INFINITY, f64::min);
            let possible = all.iter().filter(|(t, least)| *least > -1e-4 && is_within(*t, -1e-4));
            let possible = possible.map(|(t, _)| *t).fold(f64::INFINITY, f64::min);
            let distance = found.map_or(f64::INFINITY, |hit| f64::from(hit.distance));
            assert!(distance <= expected + 1e-4, "{distance} is beyond {expected}");
            near_edges += usize::from(expected != possible);
            if expected == possible {
                hits += usize::from(found.is_some());
                assert!(
                    expected == distance || (distance - expected).abs() < 1e-4,
                    "{distance}, not {expected}"
                );
            }
        }
    }
    assert!(hits > 500 && near_edges < 100, "{hits} hits, {near_edges} too close to call");
}

/// A wavy sheet of 2 * n * n triangles over the unit square, seen from above counter-clockwise.
fn sheet(n: usize) -> Vec<Triangle> {
    let at = |x: usize, y: usize| {
        let [x, y] = [x, y].map(|i| i as f32 / n as f32);
        [x, y, 0.1 * (9.0 * x).sin() * (7.0 * y).cos()]
    };
    let cells = (0..n).flat_map(|y| (0..n).map(move |x| (x, y)));
    let halves = |(x, y)| {
        let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
        [[a, b, c], [a, c, d]]
    };
    cells.flat_map(halves).collect()
}

#[test]
fn no_ray_passes_between_triangles() {
    let n = 64;
    let bvh = build(&sheet(n), 1);
    let mut stack = Stack::new();
    // The steps of an eighth of a cell put rays on vertices, on edges and on diagonals.
    for y in 8..8 * n - 8 {
        for x in 8..8 * n - 8 {
            let place = [x, y].map(|i| i as f32 / (8 * n) as f32);
            for direction in [[0.0, 0.0, -1.0], unit([0.01, -0.02, -1.0])] {
                let ray = Ray { origin: [place[0], place[1], 0.5], direction, length: 1.0 };
                let hit = bvh.nearest(&ray, Sides::Front, &mut stack).expect("the sheet has no holes");
                assert!(hit.is_front && (hit.weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
            }
        }
    }
}

/// The slow twin of a cut is the whole tree.
#[test]
fn rays_that_begin_at_a_cut_have_the_same_hits() {
    let mut dice = Dice::from_seed(17);
    let mut stack = Stack::new();
    let mut hits = 0;
    for round in 0..300 {
        let triangles = if round % 3 == 0 { sheet(40) } else { soup(&mut dice, [3, 90, 900][round % 3]) };
        let bvh = build(&triangles, 1);
        // From parallel rays at one place to any rays at all; some are parallel to axes.
        let spread = dice.pick(&[0.0, 0.01, 0.1, 1.0]);
        let mut vector = |size: f32| [0, 1, 2].map(|_| size * dice.uniform());
        let (place, along) = (vector(1.2), vector(1.0));
        let axis = [0.0, 0.0, -1.0];
        let rays: Vec<Ray> = (0..48)
            .map(|i| {
                let (by, turn) = (vector(spread), vector(0.3 * spread));
                let origin = [0, 1, 2].map(|i| place[i] + by[i]);
                let turned = [0, 1, 2].map(|i| along[i] + turn[i]);
                let direction = if round % 5 == 0 && i % 4 == 0 { axis } else { unit(turned) };
                Ray { origin, direction, length: 0.2 + i as f32 / 24.0 }
            })
            .collect();
        let prepared: Vec<PreparedRay> = rays.iter().map(|ray| bvh.prepare(ray)).collect();
        let cut = bvh.cut(&Shaft::of(&prepared).expect("there are rays"));
        for (ray, prepared) in rays.iter().zip(&prepared) {
            for sides in [Sides::Front, Sides::Both] {
                let expected = bvh.nearest(ray, sides, &mut stack);
                assert_eq!(bvh.nearest_of_cut(&cut, prepared, sides, &mut stack), expected);
                hits += usize::from(expected.is_some());
            }
        }
    }
    assert!(hits > 1000, "{hits} hits");
}

#[test]
fn sides_and_lengths_limit_hits() {
    let bvh = build(&sheet(4), 1);
    let mut stack = Stack::new();
    let below = Ray { origin: [0.4, 0.4, -1.0], direction: [0.0, 0.0, 1.0], length: 2.0 };
    assert_eq!(bvh.nearest(&below, Sides::Front, &mut stack), None);
    assert!(!bvh.nearest(&below, Sides::Both, &mut stack).expect("a hit from behind").is_front);
    let short = Ray { length: 0.5, ..below };
    assert_eq!(bvh.nearest(&short, Sides::Both, &mut stack), None);
}

#[test]
fn the_tree_is_the_same_for_every_number_of_threads() {
    let triangles = sheet(100);
    let shown = |threads| {
        let bvh = build(&triangles, threads);
        format!("{:?} {:?}", bvh.nodes, bvh.leaves)
    };
    let one = shown(1);
    assert!([2, 3, 16].iter().all(|&threads| shown(threads) == one));
}

#[test]
fn triangles_without_finite_corners_are_left_out() {
    let mut triangles = sheet(2);
    triangles[3][1][0] = f32::NAN;
    triangles[5][0][2] = f32::INFINITY;
    assert_eq!(build(&triangles, 1).triangle_count(), 6);
    let none = build(&[], 1);
    let ray = Ray { origin: [0.0; 3], direction: [0.0, 0.0, 1.0], length: 1.0 };
    assert_eq!(none.nearest(&ray, Sides::Both, &mut Stack::new()), None);
}

#[test]
fn any_arrangement_fits_the_stack() {
    // Sizes and places that grow by a factor make bins that hold one triangle and the rest.
    let grows = |i: usize| {
        let x = 1.5f32.powi(i as i32 % 180 - 90);
        [[x, 0.0, 0.0], [x, x, 0.0], [x, 0.0, x]]
    };
    let huge = |i: usize| [[f32::MAX, 0.0, i as f32], [-f32::MAX, 1.0, 0.0], [0.0, f32::MAX, 2.0]];
    for triangles in [(0..2000).map(grows).collect::<Vec<_>>(), (0..500).map(huge).collect()] {
        let bvh = build(&triangles, 2);
        assert_eq!(bvh.triangle_count(), triangles.len());
        let ray = Ray { origin: [-1.0, 0.1, 0.1], direction: [1.0, 0.0, 0.0], length: f32::MAX };
        let _any = bvh.nearest(&ray, Sides::Both, &mut Stack::new());
    }
}

//! Maps of the high surface's shape against closed forms: occlusion, bent normals, thickness, curvature.

mod support;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use darboux_bake::{
    BakeOptions, Baked, CurvatureRadius, MapKind, MapSet, OcclusionFalloff, OcclusionWeights,
};
use support::{Shape, Vector, baked, dot, unit};

/// The unit square in z = 0 with its UVs, from -1 to 1.
fn plate() -> Shape {
    rectangle([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
}

/// A rectangle, counter-clockwise from below left.
fn rectangle(corners: [[f32; 3]; 4]) -> Shape {
    let wide = |v: [f32; 3]| v.map(f64::from);
    let [a, b, _, d] = corners.map(wide);
    let sub = |a: Vector, b: Vector| [0, 1, 2].map(|i| a[i] - b[i]);
    let normal = unit(support::cross(sub(b, a), sub(d, a))).map(|x| x as f32);
    Shape {
        positions: corners.to_vec(),
        normals: vec![normal; 4],
        uvs: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        indices: vec![0, 1, 2, 0, 2, 3],
    }
}

/// Both shapes in one.
fn joined(mut a: Shape, b: &Shape) -> Shape {
    let first = a.positions.len() as u32;
    a.positions.extend(&b.positions);
    a.normals.extend(&b.normals);
    a.uvs.extend(&b.uvs);
    a.indices.extend(b.indices.iter().map(|index| first + index));
    a
}

fn options(size: u32, map: MapKind) -> BakeOptions {
    BakeOptions::new([size; 2], [0.02, 0.02]).with_maps(MapSet::of(&[map]))
}

fn mean(baked: &Baked, map: MapKind) -> f64 {
    let numbers = baked.images.numbers(map).expect("chosen");
    numbers.iter().map(|&x| f64::from(x)).sum::<f64>() / numbers.len() as f64
}

/// The largest distance of a texel from a number.
fn largest_error(baked: &Baked, map: MapKind, expected: f64) -> f64 {
    assert_eq!(baked.report.missed_texels, 0);
    let numbers = baked.images.numbers(map).expect("chosen");
    numbers.iter().map(|&x| (f64::from(x) - expected).abs()).fold(0.0, f64::max)
}

/// A sphere without its poles, of a radius; a bowl if it is turned inside out.
fn sphere(radius: f64, cells: usize, is_bowl: bool) -> Shape {
    Shape::grid(cells, false, |u, v| {
        let (a, b) = (TAU * if is_bowl { 1.0 - u } else { u }, PI * (0.1 + 0.8 * v));
        [b.sin() * a.sin(), b.cos(), b.sin() * a.cos()].map(|x| radius * x)
    })
}

fn cylinder(radius: f64, cells: usize) -> Shape {
    Shape::grid(cells, false, |u, v| [radius * (TAU * u).sin(), 4.0 - 8.0 * v, radius * (TAU * u).cos()])
}

/// A floor with a wall along the y axis: both long, with an angle between them on the side of positive x.
fn wedge(angle: f64) -> Shape {
    let far = 1000.0;
    let floor = rectangle([[0.0, -far, 0.0], [far, -far, 0.0], [far, far, 0.0], [0.0, far, 0.0]]);
    let [x, z] = [(far as f64 * angle.cos()) as f32, (far as f64 * angle.sin()) as f32];
    joined(floor, &rectangle([[x, -far, z], [0.0, -far, 0.0], [0.0, far, 0.0], [x, far, z]]))
}

/// A floor below a ceiling at a height, both wide, in one shape.
fn below_ceiling(height: f32) -> Shape {
    let far = 100.0;
    let floor = rectangle([[-far, -far, 0.0], [far, -far, 0.0], [far, far, 0.0], [-far, far, 0.0]]);
    let ceiling =
        rectangle([[-far, far, height], [far, far, height], [far, -far, height], [-far, -far, height]]);
    joined(floor, &ceiling)
}

#[test]
fn occlusion_in_a_wedge_is_what_geometry_says() {
    // A small plate on the floor, away from the wall.
    let mut low = plate();
    low.positions.iter_mut().for_each(|p| p[0] += 3.0);
    for angle in [PI / 3.0, FRAC_PI_2, 2.0] {
        let with = |weights| {
            let options = options(8, MapKind::Occlusion).with_occlusion(1024, f32::INFINITY);
            mean(&baked(&low, &wedge(angle), &options.with_occlusion_weights(weights)), MapKind::Occlusion)
        };
        // The form factor of the open part of a half plane; the share of its solid angle. The wall ends:
        // 1e-3.
        let cosine = (1.0 - angle.cos()) / 2.0;
        assert!((with(OcclusionWeights::Cosine) - cosine).abs() < 0.004, "{angle} {cosine}");
        assert!((with(OcclusionWeights::Uniform) - angle / PI).abs() < 0.004, "{angle}");
    }
}

#[test]
fn occlusion_fades_with_the_distance() {
    let (height, farthest) = (1.0f64, 4.0f64);
    let c = height / farthest;
    // The mean of f(min(c / u, 1)) for the cosine u with the density 2 u.
    let expected = [
        (OcclusionFalloff::None, c * c),
        (OcclusionFalloff::Linear, c * (2.0 - c)),
        (OcclusionFalloff::Quadratic, 1.0 - ((1.0 - c * c) - 4.0 * c * (1.0 - c) - 2.0 * c * c * c.ln())),
    ];
    for (falloff, expected) in expected {
        let options = options(8, MapKind::Occlusion).with_occlusion(1024, farthest as f32);
        let baked = baked(&plate(), &below_ceiling(height as f32), &options.with_occlusion_falloff(falloff));
        let found = mean(&baked, MapKind::Occlusion);
        assert!((found - expected).abs() < 0.004, "{falloff:?}: {found}, not {expected}");
    }
}

#[test]
fn bent_normals_lean_away_from_a_wall() {
    let mut low = plate();
    low.positions.iter_mut().for_each(|p| p[0] += 3.0);
    let maps = MapSet::of(&[MapKind::BentNormal, MapKind::ObjectBentNormal]);
    let options = options(8, MapKind::BentNormal).with_maps(maps).with_occlusion(1024, f32::INFINITY);
    let images = baked(&low, &wedge(FRAC_PI_2), &options).images;
    // The mean of the cosine-weighted directions with x > 0 is (2 / (3 pi), 0, 1 / 3).
    let expected = unit([2.0 / PI, 0.0, 1.0]);
    for map in [MapKind::BentNormal, MapKind::ObjectBentNormal] {
        for bent in images.vectors(map).expect("chosen") {
            assert!(
                dot(bent.map(f64::from), expected) > 0.01f64.cos(),
                "{map:?}: {bent:?}, not {expected:?}"
            );
        }
    }
}

#[test]
fn the_thickness_of_a_sphere_and_of_a_plate_is_what_geometry_says() {
    let (radius, rays) = (2.0, 256);
    let sphere_options = options(24, MapKind::Thickness).with_occlusion(rays, 1.0).with_samples_per_axis(2);
    // A closed sphere: the low one has no poles.
    let high = Shape::grid(160, false, |u, v| {
        let (a, b) = (TAU * u, PI * (1e-4 + 0.9998 * v));
        [b.sin() * a.sin(), b.cos(), b.sin() * a.cos()].map(|x| radius * x)
    });
    let found = baked(&sphere(radius, 48, false), &high, &sphere_options);
    // The mean of the chords 2 R u with the density 2 u.
    let error = largest_error(&found, MapKind::Thickness, 4.0 * radius / 3.0);
    assert!(error < 0.02 * radius, "{error}");

    let (depth, farthest) = (0.5, 2.0f32);
    // The lower side faces down.
    let slab = below_ceiling(-depth);
    let options = options(8, MapKind::Thickness).with_occlusion(1024, 1.0).with_thickness_distance(farthest);
    let found = mean(&baked(&plate(), &slab, &options), MapKind::Thickness);
    let expected = f64::from(depth * (2.0 - depth / farthest));
    assert!((found - expected).abs() < 0.004, "{found}, not {expected}");
}

#[test]
fn the_curvature_of_spheres_cylinders_and_planes_is_what_geometry_says() {
    let radius = 0.25;
    let options = options(32, MapKind::Curvature).with_curvature_radius(CurvatureRadius::Distance(radius));
    let error = |low: &Shape, high: &Shape, expected: f64| {
        largest_error(&baked(low, high, &options), MapKind::Curvature, expected)
    };
    // Near the ends of the open surfaces the walk leaves them, so the high ones are a little longer.
    let high = |is_bowl: bool| {
        Shape::grid(200, false, |u, v| {
            let (a, b) = (TAU * if is_bowl { 1.0 - u } else { u }, PI * (0.01 + 0.98 * v));
            [b.sin() * a.sin(), b.cos(), b.sin() * a.cos()].map(|x| 2.0 * x)
        })
    };
    let expected = f64::from(radius) / 2.0;
    let convex = error(&sphere(2.0, 64, false), &high(false), expected);
    let concave = error(&sphere(2.0, 64, true), &high(true), -expected);
    assert!(convex < 0.01 * expected && concave < 0.01 * expected, "{convex} {concave}");

    let long = Shape::grid(200, false, |u, v| [2.0 * (TAU * u).sin(), 5.0 - 10.0 * v, 2.0 * (TAU * u).cos()]);
    let error_of_cylinder = error(&cylinder(2.0, 64), &long, expected / 2.0);
    assert!(error_of_cylinder < 0.02 * expected, "{error_of_cylinder}");
    let wide = 8.0;
    let floor = rectangle([[-wide, -wide, 0.0], [wide, -wide, 0.0], [wide, wide, 0.0], [-wide, wide, 0.0]]);
    assert!(error(&plate(), &floor, 0.0) < 1e-6);
}

#[test]
fn the_curvature_of_a_torus_follows_its_angle() {
    let (large, small, radius) = (1.0, 0.4, 0.04);
    let torus = |cells| {
        Shape::grid(cells, false, |u, v| {
            let (a, b) = (TAU * u, -TAU * v);
            let ring = large + small * b.cos();
            [ring * a.sin(), small * b.sin(), ring * a.cos()]
        })
    };
    let options =
        options(48, MapKind::Curvature).with_curvature_radius(CurvatureRadius::Distance(radius as f32));
    let images = baked(&torus(96), &torus(400), &options).images;
    let numbers = images.numbers(MapKind::Curvature).expect("chosen");
    for (texel, &found) in numbers.iter().enumerate() {
        let [x, y] = [texel % 48, texel / 48];
        if ![x, y].iter().all(|place| (2..46).contains(place)) {
            continue;
        }
        let v = ((y as f64 + 0.5) / 48.0 - 0.03) / 0.94;
        let cosine = (TAU * v).cos();
        let mean = (large + 2.0 * small * cosine) / (2.0 * small * (large + small * cosine));
        let error = (f64::from(found) - radius * mean).abs();
        assert!(error < 0.02 * radius / small, "{x} {y}: {found}, not {}", radius * mean);
    }
}

#[test]
fn the_curvature_beside_an_edge_is_that_of_the_walk() {
    // The top of a step: the floor ends at x = 0 and a wall goes down from there.
    let far = 50.0;
    let top = rectangle([[-far, -far, 0.0], [0.0, -far, 0.0], [0.0, far, 0.0], [-far, far, 0.0]]);
    let wall = rectangle([[0.0, -far, -far], [0.0, far, -far], [0.0, far, 0.0], [0.0, -far, 0.0]]);
    let high = joined(top, &wall);
    let mut low = plate();
    low.positions.iter_mut().for_each(|p| p[0] -= 1.0);
    let radius = 0.5f64;
    let options =
        options(64, MapKind::Curvature).with_curvature_radius(CurvatureRadius::Distance(radius as f32));
    let images = baked(&low, &high, &options).images;
    let numbers = images.numbers(MapKind::Curvature).expect("chosen");
    for column in 0..64 {
        let distance = 2.0 - 2.0 * (column as f64 + 0.5) / 64.0;
        // Where the walk crosses the edge it meets the wall at the depth of the radius.
        let at = |angle: f64| {
            let along = distance / angle.cos();
            match (0.0..radius).contains(&along) {
                true => (distance + radius) / (along * along + radius * radius),
                false => 0.0,
            }
        };
        let steps = 4096;
        let mean = (0..steps).map(|i| at(TAU * (f64::from(i) + 0.5) / f64::from(steps))).sum::<f64>()
            / f64::from(steps);
        let found = f64::from(numbers[64 * 32 + column]);
        // Of 16 directions one more or less may cross the edge.
        let bound = 1.3 / 16.0;
        assert!((found - radius * mean).abs() < bound, "{column}: {found}, not {}", radius * mean);
    }
}

/// The sides of a box around the origin, with the normals outwards, or inwards for a room.
fn cube(half: f32, is_room: bool) -> Shape {
    let mut cube = Shape::default();
    for axis in 0..3 {
        for side in [-1.0, 1.0f32] {
            let corner = |s: f32, t: f32| {
                let mut at = [0.0; 3];
                at[axis] = side * half;
                at[(axis + 1) % 3] = s * half;
                at[(axis + 2) % 3] = side * t * half;
                at
            };
            let mut corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            if is_room {
                corners.reverse();
            }
            cube = joined(cube, &rectangle(corners));
        }
    }
    cube
}

#[test]
fn a_box_in_a_box_is_closed_and_has_the_thickness_of_its_walls() {
    let mut low = plate();
    low.positions.iter_mut().for_each(|p| *p = [0.1 * p[0], 0.1 * p[1], 1.0]);
    // A solid box in a room: no ray leaves it; with a reach of D those of a cosine below the gap over D are
    // open.
    let room = joined(cube(1.0, false), &cube(3.0, true));
    let closed = options(8, MapKind::Occlusion).with_occlusion(256, f32::INFINITY);
    assert!(largest_error(&baked(&low, &room, &closed), MapKind::Occlusion, 0.0) == 0.0);
    let near = options(8, MapKind::Occlusion).with_occlusion(1024, 2.5);
    let found = mean(&baked(&low, &room, &near), MapKind::Occlusion);
    assert!((found - (2.0f64 / 2.5).powi(2)).abs() < 0.004, "{found}");
    // A hollow box: the wall is 0.2 thick, and rays that are longer than D count as D: the mean of min(d / u,
    // D) for the cosine u with the density 2 u.
    let hollow = joined(cube(1.0, false), &cube(0.8, true));
    let (wall, reach) = (0.2, 0.5);
    let limited =
        options(8, MapKind::Thickness).with_occlusion(1024, f32::INFINITY).with_thickness_distance(0.5);
    let found = mean(&baked(&low, &hollow, &limited), MapKind::Thickness);
    assert!((found - (2.0 * wall - wall * wall / reach)).abs() < 0.003, "{found}");
}

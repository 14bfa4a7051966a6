//! Measures of tangents, compared with known values.

use darboux::{
    Context, CornerDifference, Method, TangentDifference, TangentOptions, generate_tangents,
    measure_tangents, measure_tangents_with, measure_uv_fidelity,
};
use darboux_tests::{OwnedMesh, families};

/// A tangent turned by `degrees` from x towards y.
fn turned(degrees: f64, sign: f32) -> [f32; 4] {
    let (y, x) = degrees.to_radians().sin_cos();
    [x as f32, y as f32, 0.0, sign]
}

#[test]
fn equal_tangents_do_not_differ() {
    let tangents = [turned(10.0, 1.0), turned(-170.0, -1.0)];
    let found = measure_tangents(&tangents, &tangents).expect("as many");
    assert_eq!((found.corners, found.identical, found.sign_flips, found.without_angle), (2, 2, 0, 0));
    assert_eq!((found.mean, found.max, found.histogram[0]), (0.0, 0.0, 2));
    assert!(found.worst.is_empty());
}

#[test]
fn angles_are_told_apart() {
    let angles = [0.0, 0.0005, 0.5, 2.0, 30.0, 120.0, 180.0];
    let a = vec![turned(20.0, 1.0); angles.len() + 2];
    let mut b: Vec<_> = angles.iter().map(|angle| turned(20.0 + angle, 1.0)).collect();
    b[4][3] = -1.0;
    b.extend([[0.0, 0.0, 0.0, 1.0], [f32::NAN, 0.0, 0.0, 1.0]]);
    let found = measure_tangents(&a, &b).expect("as many");
    assert_eq!((found.corners, found.identical, found.sign_flips, found.without_angle), (9, 1, 1, 2));
    // f32 coordinates near one hold an angle to some 1e-7 of a radian, 1e-5 degrees.
    let near = |found: f64, expected: f64| (found - expected).abs() < 2e-5;
    assert!(near(found.median, 2.0) && near(found.max, 180.0) && near(found.p95, 180.0), "{found:?}");
    assert!(near(found.mean, angles.iter().sum::<f64>() / 7.0), "{found:?}");
    assert_eq!(found.histogram, [1, 1, 0, 0, 1, 1, 0, 1, 0, 2]);
    let worst: Vec<usize> = found.worst.iter().map(|(corner, _)| *corner).collect();
    assert_eq!(worst, [6, 5, 4, 3, 2, 1]);
}

/// Many blocks of corners: a sort of all angles finds the same statistics, whatever the number of threads.
#[test]
fn blocks_of_corners_are_measured_as_one_list() {
    let a = vec![turned(20.0, 1.0); 300_000];
    let angle = |corner: usize| {
        [0.0, 1e-4, 3.0, 90.0, 179.0][corner % 5] * ((corner * 7_919) % 1_009) as f64 / 1_009.0
    };
    let mut b: Vec<_> = (0..a.len()).map(|corner| turned(20.0 + angle(corner), 1.0)).collect();
    b.iter_mut().step_by(1_000).for_each(|tangent| *tangent = [0.0; 4]);
    let mut angles: Vec<(f64, usize)> = (0..a.len())
        .filter_map(|corner| Some((CornerDifference::between(a[corner], b[corner]).angle?, corner)))
        .collect();
    angles.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let measured = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
        pool.install(|| measure_tangents_with(&a, &b, &mut Context::new())).expect("as many")
    };
    let found = measured(1);
    assert_eq!(found, measured(3));
    let at = |part: f64| angles[angles.len() - (part * angles.len() as f64).ceil() as usize].0;
    assert_eq!([found.median, found.p95, found.max], [0.5, 0.95, 1.0].map(at));
    assert_eq!((found.min, found.without_angle), (0.0, a.len() - angles.len()));
    let mean = angles.iter().map(|(angle, _)| angle).sum::<f64>() / angles.len() as f64;
    assert!((found.mean - mean).abs() < 1e-12 * mean, "{} {mean}", found.mean);
    let worst: Vec<(usize, f64)> = angles[..16].iter().map(|(angle, corner)| (*corner, *angle)).collect();
    assert_eq!(found.worst, worst);
}

#[test]
fn only_signs_below_zero_are_other_signs() {
    let flips = |a: f32, b: f32| CornerDifference::between(turned(0.0, a), turned(0.0, b)).flips_sign;
    for other in [0.99, 1.5, 0.0, -0.0, f32::NAN] {
        assert!(!flips(1.0, other) && flips(-1.0, other) && flips(-0.5, other), "{other}");
    }
}

#[test]
fn what_has_no_angle_is_known_where_it_is_the_same() {
    let (zero, nan) = ([0.0, 0.0, 0.0, 1.0], [f32::NAN, 0.0, 0.0, 1.0]);
    let negated = [-f32::NAN, 0.0, 0.0, 1.0];
    for (a, b, is_identical) in [(zero, zero, true), (nan, negated, true), (zero, nan, false)] {
        let found = CornerDifference::between(a, b);
        assert_eq!(
            (found.is_identical, found.is_unknown(), found.angle),
            (is_identical, !is_identical, None)
        );
    }
}

#[test]
fn every_angle_has_a_bin() {
    for (bin, end) in TangentDifference::HISTOGRAM_BIN_ENDS.iter().enumerate().skip(2) {
        let found = measure_tangents(&[turned(0.0, 1.0)], &[turned(0.99 * end, 1.0)]).expect("as many");
        assert_eq!(found.histogram[bin], 1, "{end}: {found:?}");
    }
}

#[test]
fn other_numbers_of_corners_are_an_error() {
    let error = measure_tangents(&[turned(0.0, 1.0)], &[]).expect_err("one and none");
    assert!(error.to_string().contains("corners"), "{error}");
    let mesh = families::cube(false);
    measure_uv_fidelity(&mesh.view(), &[]).expect_err("36 and none");
}

fn fidelity(mesh: &OwnedMesh, method: Method) -> darboux::UvFidelity {
    let options = TangentOptions::from(method);
    let tangents = generate_tangents(&mesh.view(), &options).corners;
    measure_uv_fidelity(&mesh.view(), tangents.per_corner()).expect("the same mesh")
}

#[test]
fn the_face_s_own_tangents_follow_the_uvs_exactly() {
    for mesh in [families::grid(9, 7, false, true), families::sphere(8, 13, false), families::cube(true)] {
        let found = fidelity(&mesh, Method::Face);
        assert!(found.root_mean_square < 1e-4 && found.unmeasured_triangles == 0, "{found:?}");
    }
}

/// A right angle between the tangents of one side of a square and the true ones turns its interpolated
/// tangents by the arctangent of x / (1 - x): 45 degrees in the mean.
#[test]
fn interpolated_tangents_are_measured_inside() {
    let mut mesh = OwnedMesh::default();
    for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
        mesh.push(([2.0 * x, 2.0 * y, 0.0], [0.0, 0.0, 1.0], [x, y]));
    }
    let mesh = mesh.with_face_list(&[vec![0, 1, 2, 3]]);
    let tangents = [turned(0.0, 1.0), turned(90.0, 1.0), turned(90.0, 1.0), turned(0.0, 1.0)];
    let found = measure_uv_fidelity(&mesh.view(), &tangents).expect("four corners");
    assert!((found.mean - 45.0).abs() < 1e-4 && (found.area - 4.0).abs() < 1e-9, "{found:?}");
}

#[test]
fn angle_area_follows_uvs_better_than_angles_alone() {
    for mesh in
        [families::sphere(8, 13, false), families::grid(9, 7, false, false), families::moebius(9, false)]
    {
        let [best, standard] = [Method::AngleArea, Method::default()].map(|method| fidelity(&mesh, method));
        assert!(best.mean < standard.mean, "{best:?} {standard:?}");
    }
}

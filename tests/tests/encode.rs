//! Encodings: the documented errors, exhaustive decoding, signs, and input without a direction.

use darboux::encode::{
    frame_from_quaternion, frame_to_quaternion, normal_from_octahedral, normal_to_octahedral,
    tangent_from_diamond, tangent_from_octahedral, tangent_from_snorm8, tangent_from_snorm10,
    tangent_from_snorm16, tangent_to_diamond, tangent_to_octahedral, tangent_to_snorm8, tangent_to_snorm10,
    tangent_to_snorm16,
};
use darboux::internal::vectors::double::{cross, dot};

type V3 = [f32; 3];

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

/// The angle between two directions, in degrees.
fn angle(a: V3, b: V3) -> f64 {
    let (a, b) = (a.map(f64::from), b.map(f64::from));
    let across = cross(a, b);
    dot(across, across).sqrt().atan2(dot(a, b)).to_degrees()
}

/// The axes and the diagonals of the cube, then a spiral that covers the sphere evenly.
fn directions(count: u32) -> impl Iterator<Item = V3> {
    let steps = || [-1.0, 0.0, 1.0];
    let special = steps()
        .into_iter()
        .flat_map(move |x| steps().into_iter().flat_map(move |y| steps().map(move |z| [x, y, z])));
    let spiral = (0..count).map(move |i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let turn = f64::from(i) * 2.399_963_229_728_653;
        let radius = (1.0 - z * z).sqrt();
        [radius * turn.cos(), radius * turn.sin(), z]
    });
    special.filter(|v| *v != [0.0; 3]).map(unit).chain(spiral).map(|v| v.map(|x| x as f32))
}

/// Unit normals, each with unit perpendiculars around it.
fn frames(count: u32, around: u32) -> impl Iterator<Item = (V3, V3)> {
    directions(count).enumerate().flat_map(move |(i, normal)| {
        let n = unit(normal.map(f64::from));
        let helper = if n[0].abs() < 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let first = unit(cross(n, helper));
        let second = cross(n, first);
        (0..around).map(move |step| {
            let (s, c) =
                (std::f64::consts::TAU * (f64::from(step) + 0.1 * i as f64) / f64::from(around)).sin_cos();
            (normal, [0, 1, 2].map(|k| (c * first[k] + s * second[k]) as f32))
        })
    })
}

/// The largest angle between a tangent and its decoded code. Checks that the sign is kept.
fn largest_turn(count: u32, mut there_and_back: impl FnMut([f32; 4]) -> [f32; 4]) -> f64 {
    let mut largest: f64 = 0.0;
    for (i, [x, y, z]) in directions(count).enumerate() {
        let w = if i % 2 == 0 { 1.0 } else { -1.0 };
        let [a, b, c, sign] = there_and_back([x, y, z, w]);
        assert_eq!(sign, w);
        largest = largest.max(angle([x, y, z], [a, b, c]));
    }
    largest
}

/// The error is below the documented bound and close to it.
fn check_bound(largest: f64, stated: f64) {
    assert!(largest < stated && largest > 0.7 * stated, "{largest} degrees, {stated} stated");
}

#[test]
fn directions_turn_by_no_more_than_stated() {
    let count = 2_000_000;
    check_bound(largest_turn(count, |t| tangent_from_snorm8(tangent_to_snorm8(t))), 0.40);
    check_bound(largest_turn(count, |t| tangent_from_snorm10(tangent_to_snorm10(t))), 0.098);
    check_bound(largest_turn(count, |t| tangent_from_snorm16(tangent_to_snorm16(t))), 0.0016);
    check_bound(largest_turn(count, |t| tangent_from_octahedral(tangent_to_octahedral(t))), 0.0057);
    let normals = |[x, y, z, w]: [f32; 4]| {
        let [x, y, z] = normal_from_octahedral(normal_to_octahedral([x, y, z]));
        [x, y, z, w]
    };
    check_bound(largest_turn(count, normals), 0.0038);
}

#[test]
fn frames_turn_by_no_more_than_stated() {
    let [mut diamond, mut normal_turn, mut tangent_turn] = [0f64; 3];
    for (i, (normal, tangent)) in frames(4_000, 500).enumerate() {
        let w = if i % 3 == 0 { -1.0 } else { 1.0 };
        let [x, y, z] = tangent;
        let [a, b, c, sign] = tangent_from_diamond(normal, tangent_to_diamond(normal, [x, y, z, w]));
        assert_eq!(sign, w);
        diamond = diamond.max(angle(tangent, [a, b, c]));

        let (n, [a, b, c, sign]) = frame_from_quaternion(frame_to_quaternion(normal, [x, y, z, w]));
        assert_eq!(sign, w);
        normal_turn = normal_turn.max(angle(normal, n));
        tangent_turn = tangent_turn.max(angle(tangent, [a, b, c]));
    }
    check_bound(diamond, 0.0071);
    check_bound(normal_turn, 0.0047);
    check_bound(tangent_turn, 0.0047);
}

#[test]
fn decoded_vectors_are_unit_and_perpendicular() {
    let near = |a: f32, b: f32| (a - b).abs() < 1e-6;
    let dot = |a: V3, b: V3| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    for (normal, [x, y, z]) in frames(2_000, 7) {
        let (n, [a, b, c, _]) = frame_from_quaternion(frame_to_quaternion(normal, [x, y, z, 1.0]));
        assert!(near(dot(n, n), 1.0) && near(dot([a, b, c], [a, b, c]), 1.0) && near(dot(n, [a, b, c]), 0.0));
        let n = normal_from_octahedral(normal_to_octahedral(normal));
        let [a, b, c, _] = tangent_from_diamond(n, tangent_to_diamond(n, [x, y, z, 1.0]));
        assert!(near(dot(n, n), 1.0) && near(dot([a, b, c], [a, b, c]), 1.0) && near(dot(n, [a, b, c]), 0.0));
    }
}

/// Decoding and encoding again gives the same code, for all codes that an encoder makes.
#[test]
fn every_code_comes_back() {
    for code in -127..=127 {
        assert_eq!(tangent_to_snorm8(tangent_from_snorm8([code, 0, 0, 127])), [code, 0, 0, 127]);
    }
    for code in -32767..=32767 {
        assert_eq!(tangent_to_snorm16(tangent_from_snorm16([0, code, 0, -32767])), [0, code, 0, -32767]);
    }
    for code in (0..1024).filter(|&code| code != 512) {
        let code = code | (1023 - code) << 10 | (1 << 30);
        if code >> 10 & 1023 != 512 {
            assert_eq!(tangent_to_snorm10(tangent_from_snorm10(code)), code);
        }
    }
    for normal in [[0.0, 0.0, 1.0], [0.6, 0.0, -0.8], [0.0, -1.0, 0.0]] {
        for code in 0..=u16::MAX {
            assert_eq!(tangent_to_diamond(normal, tangent_from_diamond(normal, code)), code);
        }
    }
}

/// Two points on the edge of the square encode one direction, so only inner points are decoded to themselves.
#[test]
fn every_point_of_the_octahedral_square_comes_back() {
    for x in (-32767..=32767i16).step_by(61) {
        for y in (-32766..=32766i16).step_by(67) {
            let inside = x.abs() < 32766 && y.abs() < 32765;
            let normal = normal_from_octahedral([x, y]);
            assert!(!inside || normal_to_octahedral(normal) == [x, y], "{x} {y}");
            let tangent = tangent_from_octahedral([x, y]);
            assert!(!inside || tangent_to_octahedral(tangent) == [x, y], "{x} {y}");
        }
    }
}

#[test]
fn the_lowest_codes_stand_for_minus_one() {
    assert_eq!(tangent_from_snorm8([-128, -127, 0, 127]), [-1.0, -1.0, 0.0, 1.0]);
    assert_eq!(tangent_from_snorm16([-32768, -32767, 0, 32767]), [-1.0, -1.0, 0.0, 1.0]);
    assert_eq!(tangent_from_snorm10(512 | 513 << 10 | 2 << 30), [-1.0, -1.0, 0.0, -1.0]);
}

#[test]
fn a_half_turn_keeps_its_sign() {
    // The scalar part of a half turn is zero: the sign survives by the bias alone.
    for (normal, [x, y, z]) in [
        ([0.0, 0.0, -1.0], [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]),
        ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]),
    ] {
        for w in [1.0, -1.0] {
            let (n, [a, b, c, sign]) = frame_from_quaternion(frame_to_quaternion(normal, [x, y, z, w]));
            assert!(sign == w && angle(n, normal) < 0.0047 && angle([a, b, c], [x, y, z]) < 0.0047);
        }
    }
}

#[test]
fn input_without_a_direction_gives_finite_output() {
    let odd = [[0.0; 3], [f32::NAN, 0.0, 1.0], [f32::INFINITY, 0.0, 0.0], [-0.0, 0.0, -0.0]];
    let up = [0.0, 0.0, 1.0];
    for [x, y, z] in odd {
        let tangent = [x, y, z, -1.0];
        let is_finite = |t: [f32; 4]| t.iter().all(|component| component.is_finite()) && t[3] == -1.0;
        assert!(is_finite(tangent_from_snorm8(tangent_to_snorm8(tangent))));
        assert!(is_finite(tangent_from_snorm10(tangent_to_snorm10(tangent))));
        assert!(is_finite(tangent_from_snorm16(tangent_to_snorm16(tangent))));
        assert!(is_finite(tangent_from_octahedral(tangent_to_octahedral(tangent))));
        assert!(is_finite(tangent_from_diamond(up, tangent_to_diamond(up, tangent))));
        let (normal, tangent) = frame_from_quaternion(frame_to_quaternion(up, tangent));
        assert!(angle(normal, up) < 0.0047 && is_finite(tangent));
        assert!(normal_from_octahedral(normal_to_octahedral([x, y, z])).iter().all(|c| c.is_finite()));
    }
}

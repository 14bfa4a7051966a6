//! A mesh rotated, scaled, mirrored, reordered or triangulated: the frames of every method must be
//! transformed alike.
//!
//! Sums are then added in another order, so that the last bits differ: by a few dozen roundings of 6e-8,
//! which thin triangles multiply by up to 10.

use darboux::{Frame, Method, TangentOptions, generate_frames};
use darboux_tests::{METHODS, OwnedMesh, families};

const TOLERANCE: f32 = 2.4e-5;

fn frames(mesh: &OwnedMesh, method: Method) -> Vec<Frame> {
    let options = TangentOptions::from(method);
    generate_frames(&mesh.view(), &options).corners.into_per_corner()
}

#[track_caller]
fn assert_near(what: &str, method: Method, expected: &[Frame], found: &[Frame]) {
    for (corner, (a, b)) in expected.iter().zip(found).enumerate() {
        let vectors = a.tangent.iter().chain(&a.bitangent).zip(b.tangent.iter().chain(&b.bitangent));
        let lengths = a.magnitude.iter().zip(&b.magnitude).map(|(a, b)| (a - b).abs() / a);
        let worst = vectors.map(|(a, b)| (a - b).abs()).chain(lengths).fold(0.0, f32::max);
        let near = worst <= TOLERANCE && a.sign == b.sign;
        assert!(near, "{what}, {method:?}, corner {corner}: {b:?} is not {a:?} ({worst:e})");
    }
}

/// Meshes without UV seams where a sum per vertex would cancel.
fn meshes() -> [OwnedMesh; 5] {
    [
        families::grid(7, 5, false, false),
        families::grid(7, 5, true, false),
        families::cube(false),
        families::sphere(6, 9, false),
        families::strip(12),
    ]
}

#[test]
fn turned() {
    let turn = |[x, y, z]: [f32; 3]| [z, x, y];
    // A perpendicular chosen from the normal alone does not turn with it.
    for method in METHODS.iter().copied().filter(|&method| method != Method::FromNormal) {
        for mut mesh in meshes() {
            let mut expected = frames(&mesh, method);
            mesh.positions.iter_mut().chain(&mut mesh.normals).for_each(|v| *v = turn(*v));
            for frame in &mut expected {
                (frame.tangent, frame.bitangent) = (turn(frame.tangent), turn(frame.bitangent));
            }
            assert_near("turned", method, &expected, &frames(&mesh, method));
        }
    }
}

#[test]
fn scaled() {
    for &method in METHODS {
        for mut mesh in meshes() {
            let mut expected = frames(&mesh, method);
            mesh.positions.iter_mut().flatten().for_each(|x| *x *= 8.0);
            mesh.uvs.iter_mut().flatten().for_each(|x| *x *= 0.5);
            let factor = if method == Method::FromNormal { 1.0 } else { 16.0 };
            expected.iter_mut().for_each(|frame| frame.magnitude = frame.magnitude.map(|x| x * factor));
            assert_near("scaled", method, &expected, &frames(&mesh, method));
        }
    }
}

#[test]
fn mirrored() {
    for method in METHODS.iter().copied().filter(|&method| method != Method::FromNormal) {
        for mut mesh in meshes() {
            let mut expected = frames(&mesh, method);
            mesh.uvs.iter_mut().for_each(|uv| uv[0] = -uv[0]);
            for frame in &mut expected {
                (frame.tangent, frame.sign) = (frame.tangent.map(|x| -x), -frame.sign);
            }
            assert_near("mirrored", method, &expected, &frames(&mesh, method));
        }
    }
}

/// Faces in another order, each with another first corner. A quad begins at the opposite corner, because a
/// tie cuts it from 0 to 2.
#[test]
fn reordered() {
    for &method in METHODS {
        for mesh in meshes() {
            let faces = mesh.face_list();
            let expected = frames(&mesh, method);
            let turned: Vec<Vec<u32>> = faces
                .iter()
                .rev()
                .map(|face| face.iter().cycle().skip(face.len() - 2).take(face.len()).copied().collect())
                .collect();
            let found = frames(&mesh.clone().with_face_list(&turned), method);
            let size = faces[0].len();
            let back = |corner: usize| {
                let (face, k) = (corner / size, corner % size);
                found[(faces.len() - 1 - face) * size + (k + 2) % size]
            };
            let found: Vec<Frame> = (0..found.len()).map(back).collect();
            assert_near("reordered", method, &expected, &found);
        }
    }
}

/// A flat quad with a parallelogram of UVs has one derivative: its halves have the same frames, cut either
/// way.
#[test]
fn cut_quads() {
    let flat = |[x, y, _]: [f32; 3]| [x, y, 0.0];
    for &method in METHODS {
        let mut mesh = families::grid(6, 5, true, false);
        mesh.positions.iter_mut().for_each(|position| *position = flat(*position));
        mesh.normals.fill([0.0, 0.0, 1.0]);
        let expected = frames(&mesh, method);
        for first in [0, 1] {
            let halves = |quad: &Vec<u32>| {
                let at = |k: usize| quad[(first + k) % 4];
                [vec![at(0), at(1), at(2)], vec![at(0), at(2), at(3)]]
            };
            let faces: Vec<Vec<u32>> = mesh.face_list().iter().flat_map(halves).collect();
            let cut = frames(&mesh.clone().with_face_list(&faces), method);
            let corner_of_half =
                |corner: usize| 4 * (corner / 6) + (first + [0, 1, 2, 0, 2, 3][corner % 6]) % 4;
            let expected: Vec<Frame> =
                (0..cut.len()).map(|corner| expected[corner_of_half(corner)]).collect();
            assert_near("cut quads", method, &expected, &cut);
        }
    }
}

/// The bitangent that a shader computes is on the side of dP/dv wherever normals agree with the winding.
#[test]
fn orthogonalized_bitangents() {
    let dot = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f32>();
    for method in METHODS.iter().copied().filter(|&method| method != Method::Face) {
        for mesh in meshes() {
            let options = TangentOptions::from(method);
            let frames = generate_frames(&mesh.view(), &options).corners;
            let found = frames.clone().orthogonalized(&mesh.view()).expect("the same mesh");
            for (corner, (frame, own)) in found.per_corner().iter().zip(frames.per_corner()).enumerate() {
                let normal = mesh.normals[mesh.vertex_of_corner(corner)];
                let (across, along) = (dot(frame.bitangent, frame.tangent), dot(frame.bitangent, normal));
                assert!(across.abs().max(along.abs()) < 1e-6, "{method:?}, corner {corner}: {frame:?}");
                assert!(
                    dot(frame.bitangent, own.bitangent) > 0.0,
                    "{method:?}, corner {corner}: {frame:?}, {own:?}"
                );
                assert_eq!(
                    (frame.tangent, frame.magnitude, frame.sign),
                    (own.tangent, own.magnitude, own.sign)
                );
            }
        }
    }
}

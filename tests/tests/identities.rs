//! A mesh in another layout, rotated or mirrored: its tangents must be transformed alike.

use darboux::{Faces, Frame, Mesh, MikkTSpaceOptions, Mode, Strided, TangentOptions, generate_frames};
use darboux_tests::{Case, OwnedMesh, families};

fn bits(frames: &[Frame]) -> Vec<[u32; 9]> {
    frames.iter().map(darboux_tests::compare::bits).collect()
}

fn frames(mesh: &Mesh<'_>, threshold: f32) -> Vec<Frame> {
    generate_frames(
        mesh,
        &TangentOptions::from(MikkTSpaceOptions::new().with_mode(Mode::Repaired).with_threshold(threshold)),
    )
    .corners
    .into_per_corner()
}

/// Position, UV and normal of each vertex in one buffer of 9 floats per vertex, one of which is unused.
fn interleaved(mesh: &OwnedMesh) -> Vec<f32> {
    let vertex = |v: usize| {
        let (p, n, t) = mesh.vertex(v);
        [p[0], p[1], p[2], t[0], t[1], 7.0, n[0], n[1], n[2]]
    };
    (0..mesh.positions.len()).flat_map(vertex).collect()
}

#[test]
fn the_layout_of_the_input_does_not_matter() {
    for seed in 0..3_000 {
        let Case { mesh, threshold } = Case::from_seed(seed);
        let sizes = mesh.face_sizes();
        let faces = || Faces::Mixed(&sizes);
        let wide: Vec<u32> =
            (0..mesh.corner_count()).map(|corner| mesh.vertex_of_corner(corner) as u32).collect();
        let narrow: Vec<u16> = wide.iter().map(|&index| index as u16).collect();
        let expected = bits(&frames(&mesh.view(), threshold));

        let buffer = interleaved(&mesh);
        let floats = |offset| Strided::from_floats(&buffer, 9, offset).expect("a layout");
        let normals = Strided::from_floats(&buffer, 9, 6).expect("a layout");
        let uvs = Strided::from_floats(&buffer, 9, 3).expect("a layout");
        let strided = Mesh::with_faces(floats(0), normals, uvs, &narrow, faces()).expect("a mesh");
        assert_eq!(
            bits(&frames(&strided, threshold)),
            expected,
            "seed {seed}: interleaved floats, 16-bit indices"
        );

        let mut bytes = vec![0xff];
        bytes.extend(buffer.iter().flat_map(|x| x.to_ne_bytes()));
        let positions = Strided::from_bytes(&bytes, 36, 1).expect("a layout");
        let normals = Strided::from_bytes(&bytes, 36, 25).expect("a layout");
        let uvs = Strided::from_bytes(&bytes, 36, 13).expect("a layout");
        let unaligned = Mesh::with_faces(positions, normals, uvs, &wide, faces()).expect("a mesh");
        assert_eq!(bits(&frames(&unaligned, threshold)), expected, "seed {seed}: unaligned bytes");
    }
}

/// In `Reference` only: a repair is shared by the corners of one vertex, and NaN keeps the corners of an
/// unindexed mesh from welding.
#[test]
fn indices_do_not_matter() {
    for seed in 0..3_000 {
        let Case { mesh, threshold } = Case::from_seed(seed);
        let options = TangentOptions::from(
            MikkTSpaceOptions::new().with_mode(Mode::Reference).with_threshold(threshold),
        );
        let [indexed, unindexed] = [&mesh, &mesh.unindexed()]
            .map(|mesh| bits(&generate_frames(&mesh.view(), &options).corners.into_per_corner()));
        assert_eq!(indexed, unindexed, "seed {seed}");
    }
}

#[test]
fn mirrored_uvs_mirror_the_frames() {
    for mut mesh in [families::grid(7, 5, false, true), families::cube(false), families::sphere(6, 9, false)]
    {
        let before = frames(&mesh.view(), 180.0);
        mesh.uvs.iter_mut().for_each(|uv| uv[0] = -uv[0]);
        for (a, b) in before.iter().zip(frames(&mesh.view(), 180.0)) {
            assert_eq!(a.sign, -b.sign);
            assert_eq!(a.tangent, b.tangent.map(|x| -x));
            assert_eq!(a.bitangent, b.bitangent);
        }
    }
}

/// Axes permuted cyclically: sums are added in another order, so the last bits may differ by a few dozen
/// roundings of 6e-8.
#[test]
fn turned_meshes_have_turned_frames() {
    let turn = |[x, y, z]: [f32; 3]| [z, x, y];
    for mut mesh in [families::grid(7, 5, true, false), families::cube(true), families::strip(12)] {
        let before = frames(&mesh.view(), 180.0);
        mesh.positions.iter_mut().chain(&mut mesh.normals).for_each(|v| *v = turn(*v));
        for (a, b) in before.iter().zip(frames(&mesh.view(), 180.0)) {
            assert_eq!(a.sign, b.sign);
            for (a, b) in turn(a.tangent).into_iter().zip(b.tangent) {
                assert!((a - b).abs() < 3e-6, "{a} and {b}");
            }
        }
    }
}

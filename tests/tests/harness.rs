//! Tests of the harness: generated meshes, the text format, shrinking.

use darboux_tests::{Case, Dice, OwnedMesh, engine, first_difference, shrink};

#[test]
fn text_keeps_every_bit() {
    for seed in 0..500 {
        let mesh = Case::from_seed(seed).mesh;
        let read = OwnedMesh::from_text(&mesh.to_text()).expect("what was written");
        assert_eq!(read.to_text(), mesh.to_text(), "seed {seed}");
        let [expected, found] = [&mesh, &read].map(|mesh| engine::reference(mesh, 180.0));
        assert!(first_difference(&expected, &found).is_none(), "seed {seed}");
    }
}

/// Cases that are rare in models must be common in generated meshes.
#[test]
fn random_meshes_are_odd() {
    const CASES: usize = 3000;
    let mut seen = [0; 6];
    for seed in 0..CASES as u64 {
        let Case { mesh, threshold } = Case::from_seed(seed);
        let frames: Vec<_> = engine::reference(&mesh, threshold).into_iter().flatten().collect();
        let faces = mesh.face_list();
        let repeats = |face: &Vec<u32>| (1..face.len()).any(|i| face[..i].contains(&face[i]));
        let odd = [
            frames.iter().any(|frame| frame.sign < 0.0) && frames.iter().any(|frame| frame.sign > 0.0),
            frames.iter().any(|frame| frame.tangent == [0.0; 3]),
            frames.iter().any(|frame| frame.tangent.iter().any(|x| x.is_nan())),
            faces.iter().any(repeats),
            faces.iter().any(|face| face.len() == 4),
            mesh.positions.as_flattened().iter().any(|x| x.to_bits() == 1 << 31),
        ];
        for (count, odd) in seen.iter_mut().zip(odd) {
            *count += usize::from(odd);
        }
    }
    println!("both signs, zero tangents, NaN, repeated vertices, quads, -0: {seen:?} of {CASES}");
    assert!(seen.iter().all(|&count| count > CASES / 50), "{seen:?} of {CASES}");
}

#[test]
fn any_bytes_make_a_mesh() {
    let mut dice = Dice::from_seed(1);
    for length in 0..400 {
        let bytes: Vec<u8> = (0..length).map(|_| dice.below(256) as u8).collect();
        let case = Case::from_bytes(&bytes);
        engine::reference(&case.mesh, case.threshold);
    }
}

#[test]
fn shrinking_keeps_the_failure() {
    let has_quad = |case: &Case| case.mesh.face_list().iter().any(|face| face.len() == 4);
    let case = (0..).map(Case::from_seed).find(|case| has_quad(case)).expect("a quad");
    let small = shrink::shrink(&case, has_quad);
    assert_eq!(small.mesh.face_list(), [[0; 4]]);
}

//! Compares the splitting of vertices on every adapter with the core.

mod common;

use common::gpus;
use darboux::{
    CornerTangents, Mesh, MikkTSpaceOptions, TangentOptions, VertexSplit, generate_tangents, split_vertices,
};
use darboux_gpu::{GpuError, Splitter};
use darboux_tests::{Case, corpus, families};

/// `Splitter` on every adapter.
fn splitters() -> Vec<Splitter> {
    gpus().iter().map(|gpu| Splitter::new(gpu).expect("valid shaders")).collect()
}

type Words = (Vec<[u32; 4]>, Vec<u32>, Vec<u32>);

fn words(split: VertexSplit) -> Words {
    let tangents = split.tangent_of_vertex.iter().map(|tangent| tangent.map(f32::to_bits)).collect();
    (tangents, split.indices, split.source_of_vertex)
}

/// Returns how many vertices were appended.
fn check(splitters: &[Splitter], name: &str, mesh: &Mesh<'_>, tangents: &CornerTangents) -> usize {
    let expected = words(split_vertices(mesh, tangents).expect("one per corner"));
    for splitter in splitters {
        let found = splitter.split_vertices(mesh, tangents).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(words(found) == expected, "{name}");
    }
    expected.2.len() - mesh.vertex_count()
}

#[test]
fn meshes_are_split_as_by_the_core() {
    let splitters = splitters();
    let mut meshes = vec![
        ("mirrored grid".into(), families::grid(60, 40, false, true)),
        ("quads".into(), families::grid(9, 9, true, true)),
        ("moebius".into(), families::moebius(64, false)),
        ("polar fan".into(), families::fan(300, true)),
        ("unindexed".into(), families::grid(8, 8, false, false).unindexed()),
    ];
    meshes.extend(corpus::corpus().into_iter().map(|corpus_case| (corpus_case.name, corpus_case.mesh)));
    meshes.extend((0..300).map(|seed| (format!("seed {seed}"), Case::from_seed(seed).mesh)));
    let mut appended = 0;
    for (name, mesh) in &meshes {
        for mode in [darboux::Mode::Reference, darboux::Mode::Repaired] {
            let options = TangentOptions::from(MikkTSpaceOptions::new().with_mode(mode).with_threshold(30.0));
            let tangents = generate_tangents(&mesh.view(), &options).corners;
            appended += check(&splitters, name, &mesh.view(), &tangents);
        }
    }
    println!("{} meshes, {appended} vertices appended", meshes.len());
    assert!(appended > 1_000);
}

#[test]
fn tangents_are_compared_as_words_and_nans_are_equal() {
    let vertices = [[0.0; 3]; 4];
    let indices: Vec<u32> =
        (0..1200).map(|corner: u32| (corner.wrapping_mul(2_654_435_761) >> 30) % 3).collect();
    let mesh = Mesh::triangles(&vertices, &vertices, &[[0.0; 2]; 4], &indices).expect("a mesh");
    let tangent = |corner: u32| match corner % 50 {
        0 => [0.0; 4],
        1 => [-0.0, 0.0, 0.0, 0.0],
        2 => [f32::NAN; 4],
        3 => [-f32::NAN; 4],
        other => [other as f32, 0.0, 0.0, 1.0],
    };
    let tangents = CornerTangents::from_per_corner((0..1200).map(tangent).collect());
    assert_eq!(check(&splitters(), "words", &mesh, &tangents), 3 * 49 - 3);
}

#[test]
fn tangents_of_another_mesh_are_refused() {
    let mesh = families::grid(2, 2, false, false);
    let few = CornerTangents::from_per_corner(vec![[0.0; 4]; 3]);
    for splitter in splitters() {
        let refused = splitter.split_vertices(&mesh.view(), &few).expect_err("another number of corners");
        assert!(matches!(refused, GpuError::Mesh(_)), "{refused}");
    }
}

//! Compares the arrays between the stages on every adapter with those of the core.

mod common;

use std::collections::HashMap;

use common::{gpus, kernels, triangulated};
use darboux::internal::stage_arrays::{NONE, Stages, Triangulation};
use darboux::{Context, MikkTSpaceOptions, Mode};
use darboux_gpu::internal::StageArrays;
use darboux_tests::{Case, OwnedMesh, corpus, families};

/// Counts of compared meshes, triangles and groups, and of meshes with values that only the core can weld.
#[derive(Debug, Default)]
struct Tally {
    meshes: usize,
    refused: usize,
    triangles: usize,
    groups: usize,
    groups_left_out: usize,
}

fn check(name: &str, mesh: &OwnedMesh, tally: &mut Tally) {
    let view = mesh.view();
    if view.face_count() == 0 {
        return;
    }
    // In this mode the order of the last edges does not matter, which only the core reproduces.
    let options = MikkTSpaceOptions::new().with_mode(Mode::Corrected);
    let core = Stages::new(&view, &options, &mut Context::new(), usize::MAX).unwrap().expect("no limit");
    for kernels in kernels() {
        let found = kernels.stage_arrays(&view, &options).unwrap_or_else(|error| panic!("{name}: {error}"));
        tally.meshes += 1;
        if found.failure_count > 0 {
            tally.refused += 1;
            continue;
        }
        check_weld(name, mesh, &core.triangulation, &found);
        check_triangles(name, &core, &found);
        check_groups(name, &core, &found, tally);
        tally.triangles += view.face_count();
    }
}

/// Checks that the welded vertices of corners form the same classes as in the core, and that each class is
/// represented by its first vertex.
fn check_weld(name: &str, mesh: &OwnedMesh, core: &Triangulation, found: &StageArrays) {
    let mut core_names = vec![NONE; mesh.corner_count()];
    for list in [&core.good, &core.degenerate] {
        for (&corner, &vertex) in list.corners.as_flattened().iter().zip(list.vertices.as_flattened()) {
            core_names[corner as usize] = vertex;
        }
    }
    let names = (0..mesh.corner_count()).map(|corner| found.welded_vertex[mesh.vertex_of_corner(corner)]);
    assert_eq!(firsts(names), firsts(core_names.into_iter()), "{name}: weld");
    let mut first = HashMap::new();
    for (v, &welded) in (0u32..).zip(&found.welded_vertex) {
        let (position, normal, uv) = mesh.vertex(v as usize);
        let key: Vec<u32> = position.iter().chain(&normal).chain(&uv).map(|x| (x + 0.0).to_bits()).collect();
        assert_eq!(welded, *first.entry(key).or_insert(v), "{name}: vertex {v}");
    }
}

/// For each element, the position of the first equal element.
fn firsts(names: impl Iterator<Item = u32>) -> Vec<usize> {
    let mut first = HashMap::new();
    names.enumerate().map(|(at, name)| *first.entry(name).or_insert(at)).collect()
}

/// Checks degenerate triangles, neighbours and orientations.
fn check_triangles(name: &str, core: &Stages, found: &StageArrays) {
    let good = &core.triangulation.good;
    let mut neighbours = vec![NONE; found.neighbours.len()];
    for (t, around) in good.face.iter().zip(&core.neighbours) {
        for (k, &other) in around.iter().enumerate().filter(|(_, other)| **other != NONE) {
            neighbours[3 * *t as usize + k] = good.face[other as usize];
        }
    }
    assert_eq!(found.neighbours, neighbours, "{name}: neighbours");
    for t in &core.triangulation.degenerate.face {
        let corners = 3 * *t as usize..3 * *t as usize + 3;
        assert_eq!(found.vertex_of_corner[corners], [NONE; 3], "{name}: triangle {t} is degenerate");
    }
    for (&t, derivative) in good.face.iter().zip(&core.derivatives) {
        let marks = u32::from(derivative.preserves) | u32::from(derivative.joins_any) << 1;
        assert_eq!(found.triangle_flags[t as usize], marks, "{name}: triangle {t}");
        assert_ne!(found.vertex_of_corner[3 * t as usize], NONE, "{name}: triangle {t} is not degenerate");
    }
}

/// Checks the groups at vertices without UV-degenerate triangles: all corners of a group, and no others, have
/// its seed.
fn check_groups(name: &str, core: &Stages, found: &StageArrays, tally: &mut Tally) {
    let good = &core.triangulation.good;
    let place = |member: u32| 3 * good.face[member as usize / 3] + member % 3;
    let mut is_any = vec![false; found.welded_vertex.len()];
    let corners = (0..).zip(&found.vertex_of_corner).filter(|(_, vertex)| **vertex != NONE);
    for (_, &vertex) in corners.filter(|(corner, _)| found.triangle_flags[corner / 3] & 2 != 0) {
        is_any[vertex as usize] = true;
    }
    let mut expected = vec![NONE; found.seed_of_corner.len()];
    for group in 0..core.groups.ends().len() {
        let members = core.groups.members(group);
        let seed = members.iter().map(|&member| place(member)).min().expect("not empty");
        members.iter().for_each(|&member| expected[place(member) as usize] = seed);
        let left_out = is_any[found.vertex_of_corner[seed as usize] as usize];
        tally.groups_left_out += usize::from(left_out);
        tally.groups += usize::from(!left_out);
    }
    for (corner, &seed) in found.seed_of_corner.iter().enumerate() {
        let vertex = found.vertex_of_corner[corner];
        if vertex != NONE && !is_any[vertex as usize] {
            assert_eq!(seed, expected[corner], "{name}: group of corner {corner}");
        }
    }
}

#[test]
fn families_have_the_arrays_of_the_core() {
    let mut tally = Tally::default();
    for (name, mesh) in [
        ("grid", families::grid(37, 23, false, false)),
        ("mirrored grid", families::grid(30, 30, false, true)),
        ("sphere", families::sphere(20, 31, false)),
        ("fan", families::fan(3_000, false)),
        ("moebius", families::moebius(64, false)),
        ("degenerates", families::with_lone_degenerates(families::grid(8, 8, false, false), 20)),
    ] {
        check(name, &mesh, &mut tally);
        check(name, &mesh.unindexed(), &mut tally);
    }
    println!("{tally:?}");
    assert!(gpus().is_empty() || (tally.refused == 0 && tally.groups > 5_000));
}

#[test]
fn corpus_and_random_meshes_have_the_arrays_of_the_core() {
    let mut tally = Tally::default();
    for corpus_case in corpus::corpus() {
        check(&corpus_case.name, &triangulated(&corpus_case.mesh), &mut tally);
    }
    for seed in 0..2_000 {
        check(&format!("seed {seed}"), &triangulated(&Case::from_seed(seed).mesh), &mut tally);
    }
    println!("{tally:?}");
    assert!(gpus().is_empty() || (tally.meshes > 3 * tally.refused && tally.groups > 10_000));
}

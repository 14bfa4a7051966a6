//! Compares libdarboux_mikktspace with mikktspace.c: one program, built with each of them, must produce the
//! same output.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use darboux_tests::{Case, Dice, OwnedMesh, corpus, families, models};

use crate::support::{
    Link, build, compiler, dist, folder, has, reference_sources, repository, run, run_with_input, source,
};

const BASIC: i32 = 1;
const FULL: i32 = 2;
const DEFAULT: i32 = 4;

/// A mesh in the input format of `drop_in.c`. Faces may have any number of corners.
struct Input<'a> {
    mesh: &'a OwnedMesh,
    sizes: Vec<i32>,
    setters: i32,
    threshold: f32,
}

impl<'a> Input<'a> {
    fn new(mesh: &'a OwnedMesh, setters: i32, threshold: f32) -> Self {
        let sizes = mesh.face_sizes().iter().map(|&size| size as i32).collect();
        Self { mesh, sizes, setters, threshold }
    }

    fn write(&self, out: &mut Vec<u8>) {
        out.extend((self.sizes.len() as i32).to_ne_bytes());
        out.extend(self.setters.to_ne_bytes());
        out.extend(self.threshold.to_ne_bytes());
        self.sizes.iter().for_each(|size| out.extend(size.to_ne_bytes()));
        for corner in 0..self.mesh.corner_count() {
            let (position, normal, uv) = self.mesh.vertex(self.mesh.vertex_of_corner(corner));
            [&position[..], &normal, &uv].concat().iter().for_each(|float| out.extend(float.to_ne_bytes()));
        }
    }
}

/// The input of `drop_in.c`: random meshes for every combination of setters.
pub fn a_few_meshes() -> Vec<u8> {
    let mut bytes = Vec::new();
    for (seed, setters) in (0..60).zip([0, BASIC, FULL, BASIC | FULL].into_iter().cycle()) {
        let case = Case::from_seed(seed);
        Input::new(&case.mesh, setters, case.threshold).write(&mut bytes);
    }
    bytes
}

/// `drop_in.c`, built once with mikktspace.c and once for each way to link libdarboux_mikktspace.
fn programs() -> &'static (PathBuf, Vec<PathBuf>) {
    static PROGRAMS: OnceLock<(PathBuf, Vec<PathBuf>)> = OnceLock::new();
    PROGRAMS.get_or_init(build_programs)
}

fn build_programs() -> (PathBuf, Vec<PathBuf>) {
    let (program, mikktspace) = (source("drop_in.c"), reference_sources());
    let reference = folder().join("drop_in-reference");
    let mut command = Command::new("gcc");
    command.args(["-O2", "-DNDEBUG", "-ffp-contract=off", "-I"]).arg(&mikktspace);
    run(command.arg(&program).arg(mikktspace.join("mikktspace.c")).args(["-lm", "-o"]).arg(&reference));
    let with_our_header = [Link::Shared, Link::Static].map(|link| {
        let files = [program.clone()];
        build(&format!("drop_in-{link:?}"), "c99", &files, &["darboux_mikktspace"], link)
    });
    // A program may keep the original header.
    let with_their_header = folder().join("drop_in-their-header");
    let mut command = compiler("c99");
    command.arg("-I").arg(&mikktspace).arg(&program).arg(dist().join("lib/libdarboux_mikktspace.a"));
    run(command.args(["-lgcc_s", "-lpthread", "-lm", "-ldl", "-o"]).arg(&with_their_header));
    (reference, with_our_header.into_iter().chain([with_their_header]).collect())
}

#[track_caller]
fn assert_same(inputs: &[Input<'_>]) {
    let mut bytes = Vec::new();
    inputs.iter().for_each(|input| input.write(&mut bytes));
    let (reference, ours) = programs();
    let expected = run_with_input(&mut Command::new(reference), &bytes).stdout;
    assert!(expected.len() > inputs.len() * 12, "the reference wrote nothing");
    for program in ours {
        let found = run_with_input(&mut Command::new(program), &bytes).stdout;
        let first = expected.iter().zip(&found).position(|(a, b)| a != b);
        assert!(expected == found, "{program:?} differs, first at byte {first:?} of {}", expected.len());
    }
}

#[test]
fn corpus_is_the_same() {
    if !has("gcc") {
        return;
    }
    let cases = corpus::corpus();
    let mut inputs = Vec::new();
    for corpus_case in &cases {
        for setters in [0, BASIC, FULL, BASIC | FULL] {
            inputs.push(Input::new(&corpus_case.mesh, setters, corpus_case.threshold));
            inputs.push(Input::new(&corpus_case.mesh, setters | DEFAULT, 0.0));
        }
    }
    assert_same(&inputs);
}

#[test]
fn models_are_the_same() {
    assert!(compare_models(&repository().join("assets")) > 8);
}

#[test]
#[ignore = "long"]
fn the_larger_set_of_models_is_the_same() {
    let Some(folder) = models::further_models() else { return };
    assert!(compare_models(&folder) > 100);
}

/// Returns the number of primitives that were compared.
fn compare_models(folder: &Path) -> usize {
    if !has("gcc") {
        return usize::MAX;
    }
    let mut count = 0;
    for path in models::models(folder) {
        let meshes = models::meshes(&path);
        let both = |mesh| [BASIC | DEFAULT, FULL].map(|setters| Input::new(mesh, setters, 180.0));
        let inputs: Vec<_> = meshes.iter().flat_map(|(_, mesh)| both(mesh)).collect();
        if !inputs.is_empty() {
            assert_same(&inputs);
        }
        count += meshes.len();
    }
    count
}

#[test]
fn random_meshes_are_the_same() {
    random_meshes(0..4_000);
}

#[test]
#[ignore = "long"]
fn many_random_meshes_are_the_same() {
    (4..200).for_each(|thousand| random_meshes(1_000 * thousand..1_000 * (thousand + 1)));
}

fn random_meshes(seeds: Range<u64>) {
    if !has("gcc") {
        return;
    }
    let cases: Vec<Case> = seeds.map(Case::from_seed).collect();
    let setters = [BASIC, FULL, BASIC | FULL];
    let with = |(at, case)| {
        let case: &Case = case;
        Input::new(&case.mesh, setters[at % 3], case.threshold)
    };
    assert_same(&cases.iter().enumerate().map(with).collect::<Vec<_>>());
}

#[test]
fn larger_meshes_are_the_same() {
    if !has("gcc") {
        return;
    }
    let meshes = [
        families::grid(60, 60, false, true),
        families::grid(60, 60, true, true),
        families::sphere(40, 40, false),
        families::sphere(40, 40, true),
    ];
    let both = meshes.iter().flat_map(|mesh| [BASIC, BASIC | FULL].map(|setters| (mesh, setters)));
    let thresholds = both.flat_map(|both| [180.0, 20.0].map(|threshold| (both, threshold)));
    let inputs = thresholds.map(|((mesh, setters), threshold)| Input::new(mesh, setters, threshold));
    assert_same(&inputs.collect::<Vec<_>>());
}

/// Faces of any number of corners, zero and negative numbers included, at the start, in the middle and at the
/// end.
#[test]
fn odd_faces_are_the_same() {
    if !has("gcc") {
        return;
    }
    let mut dice = Dice::from_seed(7);
    let vertex = |dice: &mut Dice| {
        let mut float = || dice.pick(&[0.0, 1.0, -1.0, 0.5, -0.0]);
        ([float(), float(), float()], [0.0, 0.0, 1.0], [float(), float()])
    };
    let faces: Vec<(Vec<i32>, OwnedMesh)> = (0..2_000)
        .map(|_| {
            let count = 1 + dice.below(8);
            let sizes: Vec<i32> = (0..count).map(|_| dice.pick(&[3, 4, 3, 4, 0, 1, 2, 5, -1, -7])).collect();
            let mut mesh = OwnedMesh::default();
            (0..sizes.iter().map(|&size| size.max(0)).sum()).for_each(|_| _ = mesh.push(vertex(&mut dice)));
            (sizes, mesh)
        })
        .collect();
    let mut inputs = Vec::new();
    for (sizes, mesh) in &faces {
        inputs.push(Input { mesh, sizes: sizes.clone(), setters: BASIC | FULL, threshold: 180.0 });
    }
    assert_same(&inputs);
}

/// Runs `callbacks.cpp`: the order, number and thread of callbacks, return values, exceptions, and concurrent
/// calls.
#[test]
fn callbacks_keep_their_promises() {
    if !has("g++") {
        return;
    }
    for link in [Link::Shared, Link::Static] {
        let files = [source("callbacks.cpp")];
        let program = build(&format!("callbacks-{link:?}"), "c++17", &files, &["darboux_mikktspace"], link);
        run(&mut Command::new(program));
    }
}

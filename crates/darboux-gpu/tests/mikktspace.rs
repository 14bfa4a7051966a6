//! Compares MikkTSpace on every adapter with the core, bit by bit.

mod common;

use common::{gpus, kernels, triangulated};
use darboux::{MikkTSpaceOptions, Mode, TangentOptions, Tangents, generate_tangents};
use darboux_gpu::internal::Arithmetic;
use darboux_gpu::{CpuFallback, Gpu, GpuError, GpuTangents, MikkTSpace, Splitter};
use darboux_tests::{Case, OwnedMesh, corpus, families};

/// Counts of compared corners and meshes.
#[derive(Debug, Default)]
struct Tally {
    corners: usize,
    of_cpu: usize,
    meshes: usize,
    whole_on_cpu: usize,
}

/// Compares tangents and reports with those of the core, in every mode.
fn check(name: &str, mesh: &OwnedMesh, threshold: f32, tally: &mut Tally) {
    check_with(kernels(), name, mesh, threshold, tally);
}

fn check_with(kernels: &[MikkTSpace], name: &str, mesh: &OwnedMesh, threshold: f32, tally: &mut Tally) {
    let view = mesh.view();
    for (gpu, kernels) in gpus().iter().zip(kernels) {
        for mode in [Mode::Reference, Mode::Repaired, Mode::Corrected] {
            let options =
                TangentOptions::from(MikkTSpaceOptions::new().with_mode(mode).with_threshold(threshold));
            let expected = generate_tangents(&view, &options);
            let found = kernels.generate_tangents(&view, &options);
            let GpuTangents { tangents, cpu_corners, cpu_fallback, .. } =
                found.unwrap_or_else(|error| panic!("{name}: {error}"));
            same(&format!("{name}, {mode:?}, {threshold} degrees on {}", gpu.name), &tangents, &expected);
            tally.corners += mesh.corner_count();
            tally.of_cpu += cpu_corners;
            tally.meshes += 1;
            tally.whole_on_cpu += usize::from(cpu_fallback.is_some());
        }
    }
}

fn same(name: &str, found: &Tangents, expected: &Tangents) {
    let pairs = found.corners.per_corner().iter().zip(expected.corners.per_corner());
    let bits = |tangent: &[f32; 4]| tangent.map(|x| if x.is_nan() { f32::NAN } else { x }.to_bits());
    let differs = pairs.clone().position(|(found, expected)| bits(found) != bits(expected));
    if let Some(corner) = differs {
        let pair = [found, expected].map(|tangents| tangents.corners.per_corner()[corner]);
        panic!("{name}: corner {corner} has {:?}, not {:?}", pair[0], pair[1]);
    }
    assert_eq!(found.corners.len(), expected.corners.len(), "{name}");
    assert_eq!(found.report, expected.report, "{name}");
}

#[test]
fn families_have_the_bits_of_the_core() {
    let mut tally = Tally::default();
    let meshes = [
        ("grid", families::grid(37, 23, false, false)),
        ("mirrored grid", families::grid(30, 30, false, true)),
        ("sphere", families::sphere(20, 31, false)),
        ("cube", families::cube(false)),
        ("fan", families::fan(1_000, false)),
        ("polar fan", families::fan(300, true)),
        ("moebius", families::moebius(64, false)),
        ("strip", families::strip(50)),
        ("unwelded fan", families::unwelded_fan(40)),
        ("degenerates", families::with_lone_degenerates(families::grid(8, 8, false, false), 20)),
    ];
    for (name, mesh) in meshes {
        check(name, &mesh, 180.0, &mut tally);
        check(&format!("{name}, unindexed"), &mesh.unindexed(), 180.0, &mut tally);
        check(name, &mesh, 60.0, &mut tally);
    }
    println!("{tally:?}");
    // In the stress build tiles are small, and many vertices lie between them.
    assert!(tally.of_cpu * 4 < tally.corners || gpus().is_empty() || cfg!(small_limits));
}

#[test]
fn corpus_has_the_bits_of_the_core() {
    let mut tally = Tally::default();
    for corpus_case in corpus::corpus() {
        check(&corpus_case.name, &corpus_case.mesh, corpus_case.threshold, &mut tally);
        let triangles = triangulated(&corpus_case.mesh);
        check(&format!("{} in triangles", corpus_case.name), &triangles, corpus_case.threshold, &mut tally);
    }
    println!("{tally:?}");
}

#[test]
fn random_meshes_have_the_bits_of_the_core() {
    let mut tally = Tally::default();
    for seed in 0..500 {
        let Case { mesh, threshold } = Case::from_seed(seed);
        check(&format!("seed {seed}"), &triangulated(&mesh), threshold, &mut tally);
    }
    println!("{tally:?}");
    assert!(tally.whole_on_cpu * 2 < tally.meshes || gpus().is_empty());
}

#[test]
fn work_of_the_cpu_is_reported() {
    let grid = families::grid(4, 4, false, false);
    let quads = families::grid(4, 4, true, false);
    let mut endless = grid.clone();
    endless.positions[3][1] = f32::INFINITY;
    for kernels in kernels() {
        let run = |mesh: &OwnedMesh| kernels.generate_tangents(&mesh.view(), &Default::default()).unwrap();
        assert_eq!(run(&grid).cpu_fallback, None);
        assert_eq!((run(&quads).cpu_fallback, run(&quads).cpu_corners), (Some(CpuFallback::Faces), 64));
        assert_eq!((run(&endless).cpu_fallback, run(&endless).cpu_corners), (Some(CpuFallback::Values), 96));
    }
}

#[test]
fn meshes_in_tiles_have_the_bits_of_the_core() {
    let tiled: Vec<_> = kernels().iter().map(|kernels| kernels.clone().with_tile_size(300)).collect();
    let mut tally = Tally::default();
    for (name, mesh) in [
        ("grid", families::grid(37, 23, false, true)),
        ("sphere", families::sphere(20, 31, false)),
        ("fan", families::fan(1_000, false)),
    ] {
        check_with(&tiled, name, &mesh, 180.0, &mut tally);
        check_with(&tiled, name, &mesh.unindexed(), 180.0, &mut tally);
    }
    println!("{tally:?}");
    assert!(gpus().is_empty() || tally.of_cpu * 3 < tally.corners);
}

#[test]
fn integer_arithmetic_has_the_bits_of_the_core() {
    let soft = |gpu| MikkTSpace::with_arithmetic(gpu, Arithmetic::SoftFloat).expect("valid shaders");
    let soft: Vec<_> = gpus().iter().map(soft).collect();
    let mut tally = Tally::default();
    check_with(&soft, "sphere", &families::sphere(20, 31, false), 180.0, &mut tally);
    for seed in 0..60 {
        let Case { mesh, threshold } = Case::from_seed(seed);
        check_with(&soft, &format!("seed {seed}"), &triangulated(&mesh), threshold, &mut tally);
    }
    println!("{tally:?}");
}

/// The npm package runs MikkTSpace in this way.
#[test]
fn unsure_items_are_deferred_to_the_cpu() {
    let deferring = |gpu| MikkTSpace::with_arithmetic(gpu, Arithmetic::CpuFallback).expect("valid shaders");
    let deferring: Vec<_> = gpus().iter().map(deferring).collect();
    let sphere = families::sphere(20, 31, false);
    let mut tiny = sphere.clone();
    tiny.positions.as_flattened_mut().iter_mut().for_each(|x| *x *= 2f32.powi(-70));
    let (mut plain, mut left) = (Tally::default(), Tally::default());
    check_with(&deferring, "sphere", &sphere, 180.0, &mut plain);
    check_with(&deferring, "a tiny sphere", &tiny, 180.0, &mut left);
    println!("{plain:?}, {left:?}");
    assert!(plain.of_cpu < left.of_cpu && left.of_cpu == left.corners || gpus().is_empty());
    let mut random = Tally::default();
    for seed in 0..200 {
        let Case { mesh, threshold } = Case::from_seed(seed);
        check_with(&deferring, &format!("seed {seed}"), &triangulated(&mesh), threshold, &mut random);
    }
    println!("{random:?}");
}

/// More triangles than fit in a binding of 128 MiB, which all devices support.
#[test]
#[ignore = "half a minute and a gigabyte"]
fn meshes_past_a_binding_have_the_bits_of_the_core() {
    let mesh = families::grid(1_000, 750, false, true);
    let options = TangentOptions::default();
    let expected = generate_tangents(&mesh.view(), &options);
    for (gpu, kernels) in gpus().iter().zip(kernels()) {
        let made = kernels.generate_tangents(&mesh.view(), &options);
        let made = made.unwrap_or_else(|error| panic!("{}: {error}", gpu.name));
        same(&gpu.name, &made.tangents, &expected);
        println!("{}: {} of {} corners on the CPU", gpu.name, made.cpu_corners, mesh.corner_count());
        assert!(made.cpu_corners * 100 < mesh.corner_count());
    }
}

#[test]
fn a_lost_device_is_an_error() {
    let mesh = families::grid(4, 4, false, false);
    let lost = gpus().iter().map(|_| pollster::block_on(Gpu::open()).expect("a second device"));
    for gpu in lost {
        let kernels = MikkTSpace::new(&gpu).expect("valid shaders");
        let splitter = Splitter::new(&gpu).expect("valid shaders");
        gpu.device.destroy();
        let run = kernels.generate_tangents(&mesh.view(), &Default::default());
        assert_eq!(run.err(), Some(GpuError::Lost));
        let tangents = generate_tangents(&mesh.view(), &Default::default()).corners;
        assert_eq!(splitter.split_vertices(&mesh.view(), &tangents).err(), Some(GpuError::Lost));
    }
}

//! Tests that plans in fast precision give the core's tangents within a bound, and the same signs.

mod common;

use std::path::{Path, PathBuf};

use common::bound::length;
use common::plan_bound::bounds;
use common::plans::run;
use common::{gpus, triangulated};
use darboux::internal::stage_arrays::Stages;
use darboux::{Context, MikkTSpaceOptions, Mode};
use darboux_gpu::{Gpu, Planner, Precision, TangentsPer};
use darboux_tests::{Case, OwnedMesh, families, models};

/// Counts of compared tangents, the largest error in radians, and the largest error as a fraction of its
/// bound.
#[derive(Debug, Default)]
struct Tally {
    compared: usize,
    unknown: usize,
    largest: f64,
    of_bound: f64,
}

fn check(planner: &Planner, gpu: &Gpu, name: &str, mesh: &OwnedMesh, tally: &mut Tally) {
    let mesh = &triangulated(mesh);
    let options = MikkTSpaceOptions::new().with_mode(Mode::Reference);
    let stages =
        Stages::new(&mesh.view(), &options, &mut Context::new(), 1 << 22).unwrap().expect("small groups");
    let bounds = bounds(&stages, mesh);
    let found = run(planner, gpu, [mesh, mesh], Mode::Reference, TangentsPer::Corner);
    let expected = darboux::generate_tangents(&mesh.view(), &options.into()).corners;
    for (corner, found) in found.words.as_chunks::<4>().0.iter().enumerate() {
        let (found, expected) = (found.map(f32::from_bits), expected.per_corner()[corner]);
        assert_eq!(found[3], expected[3], "{name}, corner {corner}: sign");
        let [sum, _] = stages.sums.of_corner[corner];
        let Some(bound) = bounds.get(sum as usize).copied().flatten() else {
            tally.unknown += 1;
            continue;
        };
        // Both have errors.
        let error = length([0, 1, 2].map(|i| f64::from(found[i]) - f64::from(expected[i])));
        assert!(error <= 2.0 * bound, "{name}, corner {corner}: off by {error:e}, not {bound:e}");
        tally.compared += 1;
        tally.largest = tally.largest.max(error);
        tally.of_bound = tally.of_bound.max(error / (2.0 * bound));
    }
}

fn each(what: &str, meshes: impl Fn() -> Vec<(String, OwnedMesh)>, least: usize) {
    for gpu in gpus() {
        let planner = Planner::new(&gpu.device, Precision::Fast);
        let mut tally = Tally::default();
        for (name, mesh) in meshes().iter().filter(|(_, mesh)| mesh.corner_count() > 0) {
            check(&planner, gpu, name, mesh, &mut tally);
        }
        println!("{what} on {}: {tally:?}", gpu.name);
        assert!(tally.compared > least);
    }
}

#[test]
fn families_are_within_the_bound() {
    let meshes = || {
        vec![
            ("grid".to_owned(), families::grid(37, 23, false, true)),
            ("sphere".to_owned(), families::sphere(20, 31, false)),
            ("fan".to_owned(), families::fan(1_000, false)),
            ("moebius".to_owned(), families::moebius(64, false)),
        ]
    };
    each("families", meshes, 10_000);
}

#[test]
fn models_are_within_the_bound() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    let of_model = |path: PathBuf| {
        let name = path.display().to_string();
        models::meshes(&path).into_iter().map(move |(number, mesh)| (format!("{name}, {number}"), mesh))
    };
    each("models", || models::models(&folder).into_iter().flat_map(of_model).collect(), 1_000);
}

#[test]
fn random_meshes_are_within_the_bound() {
    let of_seed = |seed| (format!("seed {seed}"), Case::from_seed(seed).mesh);
    each("random meshes", || (0..400).map(of_seed).collect(), 500);
}

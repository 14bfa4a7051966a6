//! Cancellation of runs on every adapter, by counting the checks of a token: times depend on the machine.

mod common;

use common::{gpus, kernels, triangulated};
use darboux::internal::cancel_checks::{cancel_after, check_count};
use darboux::{Cancel, Context, TangentOptions, generate_tangents, split_vertices};
use darboux_gpu::{GpuError, MikkTSpace, Planner, Precision, Splitter};
use darboux_tests::{OwnedMesh, families};

/// The most checks of a call after the one that cancels it.
const CHECKS_AFTER: usize = 48;

/// A run checks its token at least `least` times, and ends soon after any check that cancels it.
fn ends_when_cancelled(name: &str, least: usize, run: impl Fn(&mut Context) -> Result<(), GpuError>) {
    let run_with_limit = |limit| {
        let cancel = cancel_after(limit);
        (run(&mut Context::new().with_cancel(&cancel)), check_count(&cancel))
    };
    let (result, all) = run_with_limit(usize::MAX);
    assert_eq!(result, Ok(()), "{name}");
    assert!(all >= least, "{name}: {all} checks");
    for limit in (0..5).map(|fifths| least * fifths / 5) {
        let (result, made) = run_with_limit(limit);
        assert_eq!(result, Err(GpuError::Cancelled), "{name}: cancelled at check {limit}");
        assert!(made - limit <= CHECKS_AFTER, "{name}: {made} checks, cancelled at {limit}");
    }
}

/// Cancels MikkTSpace in `tiles` tiles: each tile is submitted once and read once.
fn tiles_end_when_cancelled(name: &str, kernels: &MikkTSpace, mesh: &OwnedMesh, tiles: usize) {
    let options = TangentOptions::default();
    ends_when_cancelled(name, 2 * tiles, |context| {
        kernels.generate_tangents_with(&mesh.view(), &options, context).map(drop)
    });
}

#[test]
fn mikktspace_is_cancelled_between_submissions() {
    let mesh = families::grid(100, 100, false, true);
    for kernels in kernels() {
        let tiled = kernels.clone().with_tile_size(2_000);
        tiles_end_when_cancelled("tiles", &tiled, &mesh, mesh.corner_count().div_ceil(3 * 2_000));
        let expected = generate_tangents(&mesh.view(), &TangentOptions::default());
        let context = &mut Context::new().with_cancel(&Cancel::new());
        let made = tiled.generate_tangents_with(&mesh.view(), &TangentOptions::default(), context);
        let made = made.expect("a run that nobody cancels").tangents;
        assert!(made.corners.per_corner() == expected.corners.per_corner(), "after cancelled runs");
    }
}

/// Faces that are not triangles are computed by the CPU, with the same token.
#[test]
fn the_run_of_the_cpu_is_cancelled() {
    let mesh = families::grid(100, 100, true, true);
    for kernels in kernels() {
        tiles_end_when_cancelled("quads", kernels, &mesh, 1);
    }
}

#[test]
fn splitting_and_planning_are_cancelled() {
    let mesh = triangulated(&families::grid(60, 50, false, true));
    let (view, options) = (mesh.view(), TangentOptions::default());
    let tangents = generate_tangents(&view, &options).corners;
    for gpu in gpus() {
        let splitter = Splitter::new(gpu).expect("valid shaders");
        ends_when_cancelled("split", 4, |context| {
            splitter.split_vertices_with(&view, &tangents, context).map(drop)
        });
        assert_eq!(splitter.split_vertices(&view, &tangents), Ok(split_vertices(&view, &tangents).unwrap()));
        let planner = Planner::new(&gpu.device, Precision::Exact);
        ends_when_cancelled("plan", 5, |context| planner.plan_with(&view, &options, context).map(drop));
    }
}

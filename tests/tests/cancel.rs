//! Work that is told to stop.

use std::time::Duration;

use darboux::{
    Cancel, CornerTangents, Frame, Mesh, MeshError, NormalOptions, NormalPlan, Plan, Scratch, TangentOptions,
    generate_frames, generate_normals, generate_tangents, lend_frames, measure_tangents, measure_uv_fidelity,
    write_frames, write_tangents,
};
use darboux_tests::{OwnedMesh, families};

fn options(threshold: f32) -> TangentOptions {
    TangentOptions { threshold, ..TangentOptions::default() }
}

/// Below 180 degrees a fan costs its size squared: this one would take minutes.
fn endless() -> OwnedMesh {
    families::fan(1 << 18, true)
}

/// Runs work and asks it to stop soon after.
fn stopped<R: Send>(work: impl FnOnce() -> R + Send) -> Result<R, MeshError> {
    let cancel = &Cancel::new();
    std::thread::scope(|scope| {
        let run = scope.spawn(|| cancel.run(work));
        std::thread::sleep(Duration::from_millis(200));
        cancel.cancel();
        run.join().expect("no panic")
    })
}

#[test]
fn ends_long_runs_of_every_kind() {
    let (mesh, options) = (&endless(), &options(90.0));
    let count = mesh.corner_count();
    let mut tangents = vec![[0.0; 4]; count];
    let mut frames = vec![Frame::default(); count];
    let written = stopped(|| write_tangents(&mesh.view(), options, &mut Scratch::new(), &mut tangents));
    assert_eq!(written.map(drop), Err(MeshError::Cancelled));
    let written = stopped(|| write_frames(&mesh.view(), options, &mut Scratch::new(), &mut frames));
    assert_eq!(written.map(drop), Err(MeshError::Cancelled));
    assert_eq!(stopped(|| generate_tangents(&mesh.view(), options)).map(drop), Err(MeshError::Cancelled));
    assert_eq!(stopped(|| generate_frames(&mesh.view(), options)).map(drop), Err(MeshError::Cancelled));
    assert_eq!(stopped(|| Plan::new(&mesh.view(), options)).map(drop), Err(MeshError::Cancelled));
}

/// What every function that can say so says where it was asked to stop before it began. Where it was not: nothing.
fn said(cancel: &Cancel, mesh: &Mesh<'_>, plan: &Plan, normals: &NormalPlan) -> Vec<Result<(), MeshError>> {
    let (options, mut said) = (&options(180.0), Vec::new());
    let tangents = plan.base().corners.per_corner();
    let mut scratch = Scratch::new();
    let (mut corners, mut frames) = (tangents.to_vec(), vec![Frame::default(); mesh.corner_count()]);
    _ = cancel.run(|| {
        said.push(write_tangents(mesh, options, &mut scratch, &mut corners).map(drop));
        said.push(write_frames(mesh, options, &mut scratch, &mut frames).map(drop));
        said.push(lend_frames(mesh, options, &mut scratch).map(drop));
        said.push(plan.evaluate_into(mesh, &mut scratch, &mut CornerTangents::default()));
        said.push(plan.count_regrouped(mesh).map(drop));
        let normal_options = &NormalOptions { crease: 30.0, ..NormalOptions::default() };
        let made = generate_normals(mesh.positions(), mesh.indices(), mesh.faces(), normal_options);
        said.push(made.map(drop));
        said.push(normals.evaluate(mesh.positions()).map(drop));
        said.push(measure_tangents(tangents, tangents).map(drop));
        said.push(measure_uv_fidelity(mesh, tangents).map(drop));
    });
    said
}

#[test]
fn every_function_says_that_it_was_stopped() {
    for (mesh, threads) in
        [(families::grid(4, 3, true, true), 1), (families::grid(160, 150, false, false), 3)]
    {
        let mesh = mesh.view();
        let plan = Plan::new(&mesh, &options(180.0));
        let normals =
            NormalPlan::new(mesh.positions(), mesh.indices(), mesh.faces(), &NormalOptions::default())
                .unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
        pool.install(|| {
            let cancel = Cancel::new();
            assert!(said(&cancel, &mesh, &plan, &normals).iter().all(Result::is_ok));
            cancel.cancel();
            let said_then = said(&cancel, &mesh, &plan, &normals);
            assert!(said_then.iter().all(|said| *said == Err(MeshError::Cancelled)), "{said_then:?}");
            assert_eq!(said_then.len(), 9);
            // What comes after a run does not hear it.
            assert!(said(&Cancel::new(), &mesh, &plan, &normals).iter().all(Result::is_ok));
            assert!(plan.evaluate(&mesh).is_ok());
        });
    }
}

#[test]
fn a_stopped_run_leaves_scratch_and_plan_whole() {
    let [mesh, moved] = [1.0, 1.5].map(|scale| {
        let mut mesh = families::grid(40, 30, false, true);
        mesh.positions.iter_mut().for_each(|position| position[2] *= scale);
        mesh
    });
    let (view, moved, options) = (mesh.view(), moved.view(), options(180.0));
    let (plan, fresh) = (Plan::new(&view, &options), Plan::new(&view, &options));
    let (mut scratch, mut corners) = (Scratch::new(), vec![[0.0; 4]; mesh.corner_count()]);
    let cancel = Cancel::new();
    cancel.cancel();
    let stopped = cancel.run(|| {
        _ = write_tangents(&view, &options, &mut scratch, &mut corners);
        _ = plan.evaluate(&moved);
    });
    assert_eq!(stopped, Err(MeshError::Cancelled));
    plan.write_tangents(&moved, &mut scratch, &mut corners).unwrap();
    assert_eq!(&corners, fresh.evaluate(&moved).unwrap().per_corner());
}

//! Cancellation.

use std::time::Duration;

use darboux::internal::cancel_checks::{cancel_after, check_count};
use darboux::internal::gpu_resume;
use darboux::{
    Cancel, Choice, Context, CornerNormals, CornerTangentsRef, Error, Frame, Mesh, Method, MikkTSpaceOptions,
    NormalOptions, NormalPlan, Plan, Splitter, TangentOptions, generate_compact_frames, generate_frames_with,
    generate_normals_with, generate_tangents_with, measure_tangents_with, measure_uv_fidelity_with,
    split_normals_with, split_vertices_with, write_frames, write_tangents,
};
use darboux_tests::{OwnedMesh, families};

fn options(threshold: f32) -> TangentOptions {
    TangentOptions::from(MikkTSpaceOptions::new().with_threshold(threshold))
}

/// Below 180 degrees a fan takes time quadratic in its size: this one would take minutes.
fn endless() -> OwnedMesh {
    families::fan(1 << 18, true)
}

/// Starts work and cancels it soon after.
fn cancelled<R: Send>(work: impl FnOnce(&mut Context) -> Result<R, Error> + Send) -> Option<Error> {
    let cancel = Cancel::new();
    let mut context = Context::new().with_cancel(&cancel);
    std::thread::scope(|scope| {
        let run = scope.spawn(move || work(&mut context).err());
        std::thread::sleep(Duration::from_millis(200));
        cancel.cancel();
        run.join().expect("no panic")
    })
}

#[test]
fn ends_long_runs_of_every_kind() {
    let (mesh, options) = (&endless(), &options(90.0));
    let view = &mesh.view();
    let mut tangents = vec![[0.0; 4]; mesh.corner_count()];
    let mut frames = vec![Frame::default(); mesh.corner_count()];
    let expected = Some(Error::Cancelled);
    assert_eq!(cancelled(|context| write_tangents(view, options, context, &mut tangents)), expected);
    assert_eq!(cancelled(|context| write_frames(view, options, context, &mut frames)), expected);
    assert_eq!(cancelled(|context| generate_tangents_with(view, options, context)), expected);
    assert_eq!(cancelled(|context| generate_frames_with(view, options, context)), expected);
    assert_eq!(cancelled(|context| Plan::new_with(view, options, context)), expected);
}

/// A token works also where the caller's closure runs the work on the threads of a pool.
#[test]
fn ends_work_that_moves_to_a_pool() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a thread pool");
    let (mesh, options) = (&endless(), &options(90.0));
    let run = |context: &mut Context| pool.install(|| generate_tangents_with(&mesh.view(), options, context));
    assert_eq!(cancelled(run), Some(Error::Cancelled));
}

/// The result of every function that takes a context.
fn results(
    context: &mut Context,
    mesh: &Mesh<'_>,
    plan: &Plan,
    normals: &NormalPlan,
) -> Vec<Result<(), Error>> {
    let (options, mut results) = (&options(180.0), Vec::new());
    let tangents = plan.base().corners.per_corner();
    let (mut corners, mut frames) = (tangents.to_vec(), vec![Frame::default(); mesh.corner_count()]);
    results.push(write_tangents(mesh, options, context, &mut corners).map(drop));
    results.push(write_frames(mesh, options, context, &mut frames).map(drop));
    results.push(generate_compact_frames(mesh, options, context).map(drop));
    results.push(generate_tangents_with(mesh, options, context).map(drop));
    results.push(generate_frames_with(mesh, options, context).map(drop));
    results.push(Plan::new_with(mesh, options, context).map(drop));
    results.push(plan.write_tangents(mesh, context, &mut corners));
    results.push(plan.evaluate_with(mesh, context).map(drop));
    results.push(plan.count_regrouped_with(mesh, context).map(drop));
    let creased = &NormalOptions::new().with_crease(30.0);
    let (positions, indices, faces) = (mesh.positions(), mesh.indices(), mesh.faces());
    results.push(generate_normals_with(positions, indices, faces, creased, context).map(drop));
    results.push(NormalPlan::new_with(positions, indices, faces, creased, context).map(drop));
    results.push(normals.evaluate_with(positions, context).map(drop));
    results.push(measure_tangents_with(tangents, tangents, context).map(drop));
    results.push(measure_uv_fidelity_with(mesh, tangents, context).map(drop));
    results.push(split_vertices_with(mesh, &plan.base().corners, context).map(drop));
    results.push(Splitter::new_with(mesh.vertex_count(), context).add(mesh, &plan.base().corners).map(drop));
    let zeros = CornerNormals::from_per_corner(vec![[0.0; 3]; mesh.corner_count()]);
    results.push(split_normals_with(mesh.vertex_count(), indices, &zeros, context).map(drop));
    results
}

#[test]
fn every_function_returns_that_it_was_cancelled() {
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
            let mut context = Context::new().with_cancel(&cancel);
            assert!(results(&mut context, &mesh, &plan, &normals).iter().all(Result::is_ok));
            cancel.cancel();
            let after = results(&mut context, &mesh, &plan, &normals);
            assert!(after.iter().all(|result| *result == Err(Error::Cancelled)), "{after:?}");
            assert_eq!(after.len(), 17);
            // Other contexts are not concerned, and this one is usable again without the token.
            assert!(results(&mut Context::new(), &mesh, &plan, &normals).iter().all(Result::is_ok));
            context.set_cancel(None);
            assert!(results(&mut context, &mesh, &plan, &normals).iter().all(Result::is_ok));
        });
    }
}

/// Every method, and MikkTSpace with a threshold that leaves nothing to the fast path.
fn methods() -> impl Iterator<Item = Method> {
    let scattered = Method::MikkTSpace(MikkTSpaceOptions::new().with_threshold(0.0));
    Method::ALL.iter().copied().chain([scattered])
}

/// A call of the library with a context.
type Call<'a> = Box<dyn Fn(&mut Context) -> Result<(), Error> + Sync + 'a>;

/// Every long computation, by every method.
fn computations<'a>(mesh: &'a Mesh<'a>, plans: &'a [Plan], welded: &'a [u32]) -> Vec<(String, Call<'a>)> {
    let mut calls: Vec<(String, Call<'a>)> = Vec::new();
    for (method, plan) in methods().zip(plans) {
        let options = TangentOptions::from(method);
        let mut add = |what: &str, call: Call<'a>| calls.push((format!("{what} {method:?}"), call));
        add("tangents", Box::new(move |context| generate_tangents_with(mesh, &options, context).map(drop)));
        add("frames", Box::new(move |context| generate_frames_with(mesh, &options, context).map(drop)));
        add("plan", Box::new(move |context| Plan::new_with(mesh, &options, context).map(drop)));
        add("evaluation", Box::new(move |context| plan.evaluate_with(mesh, context).map(drop)));
    }
    let mut add = |what: &str, call: Call<'a>| calls.push((what.to_owned(), call));
    let creased = NormalOptions::new().with_crease(30.0);
    add(
        "normals",
        Box::new(move |context| {
            let (positions, indices) = (mesh.positions(), mesh.indices());
            generate_normals_with(positions, indices, mesh.faces(), &creased, context).map(drop)
        }),
    );
    add(
        "completion of a GPU's run",
        Box::new(move |context| {
            let mut out = vec![[0.0, 0.0, 0.0, gpu_resume::UNDECIDED]; mesh.corner_count()];
            let options = MikkTSpaceOptions::new();
            gpu_resume::complete(mesh, &options, welded.to_vec(), context, &mut out).map(drop)
        }),
    );
    let tangents = plans[0].base().corners.per_corner();
    add("comparison", Box::new(move |context| measure_tangents_with(tangents, tangents, context).map(drop)));
    add("fidelity", Box::new(move |context| measure_uv_fidelity_with(mesh, tangents, context).map(drop)));
    add(
        "split",
        Box::new(move |context| {
            split_vertices_with(mesh, CornerTangentsRef::from_per_corner(tangents), context).map(drop)
        }),
    );
    calls
}

/// What is wrong with the checks of a call on up to `threads` threads: it makes fewer than `least`, or more
/// than [`CHECKS_AFTER`] once it is cancelled.
fn failures_of(name: &str, call: &Call<'_>, threads: usize, least: usize) -> Vec<String> {
    const CHECKS_AFTER: usize = 48;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
    let checks_of = |limit| {
        let cancel = cancel_after(limit);
        let mut context = Context::new().with_cancel(&cancel).with_max_threads(threads);
        let result = pool.install(|| call(&mut context));
        (result, check_count(&cancel))
    };
    let mut failures = Vec::new();
    let (result, all) = checks_of(usize::MAX);
    if result.is_err() || all < least {
        failures.push(format!("{name}: {all} checks, {result:?}"));
    }
    for limit in (0..5).map(|fifths| all * fifths / 5) {
        let (result, made) = checks_of(limit);
        if result != Err(Error::Cancelled) || made - limit > CHECKS_AFTER {
            failures.push(format!("{name}: cancelled at {limit} of {all}, {made} checks, {result:?}"));
        }
    }
    failures
}

/// The time depends on the machine, so this counts checks of the token instead: a call checks it often
/// enough, and once it is cancelled makes only as many further checks as there are stages and threads.
#[test]
fn every_computation_checks_the_token_regularly_and_stops_soon() {
    const TRIANGLES_PER_CHECK: usize = 1 << 14;
    let mesh = families::grid(150, 150, false, true);
    let mesh = &mesh.view();
    let welded: Vec<u32> = (0..mesh.vertex_count() as u32).collect();
    let plans: Vec<Plan> = methods().map(|method| Plan::new(mesh, &TangentOptions::from(method))).collect();
    let mut failures = Vec::new();
    for threads in [1, 3] {
        for (name, call) in &computations(mesh, &plans, &welded) {
            failures.extend(failures_of(name, call, threads, mesh.face_count() / TRIANGLES_PER_CHECK));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Below 180 degrees, all pairs of the triangles at one vertex are compared where some tangent is far from
/// the mean.
#[test]
fn a_large_fan_below_180_degrees_checks_the_token_between_its_triangles() {
    const TRIANGLES_PER_CHECK: usize = 64;
    let (mesh, options) = (&families::sector(1 << 12), &options(90.0));
    let mesh = &mesh.view();
    let call: Call<'_> = Box::new(|context| generate_tangents_with(mesh, options, context).map(drop));
    let failures = failures_of("sector", &call, 1, mesh.face_count() / TRIANGLES_PER_CHECK);
    assert!(failures.is_empty(), "{failures:#?}");
    let plan = Plan::new(mesh, options);
    assert_eq!(plan.base().report.split_vertices, 0, "all tangents of the vertex join");
}

#[test]
fn a_cancelled_run_leaves_context_and_plan_usable() {
    let [mesh, moved] = [1.0, 1.5].map(|scale| {
        let mut mesh = families::grid(40, 30, false, true);
        mesh.positions.iter_mut().for_each(|position| position[2] *= scale);
        mesh
    });
    let (view, moved, options) = (mesh.view(), moved.view(), options(180.0));
    let (plan, fresh) = (Plan::new(&view, &options), Plan::new(&view, &options));
    let mut corners = vec![[0.0; 4]; mesh.corner_count()];
    let cancel = Cancel::new();
    cancel.cancel();
    let mut context = Context::new().with_cancel(&cancel);
    assert!(write_tangents(&view, &options, &mut context, &mut corners).is_err());
    assert!(plan.evaluate_with(&moved, &mut context).is_err());
    context.set_cancel(None);
    plan.write_tangents(&moved, &mut context, &mut corners).unwrap();
    assert_eq!(&corners, fresh.evaluate(&moved).unwrap().per_corner());
}

//! Every engine against the reference, bit for bit, on random meshes.

use darboux::Mode;
use darboux_tests::{Case, assert_equal, engine, engines, first_difference, shrink};

/// Runs the cases of `seeds`. The mesh of a difference is shrunk before it is printed.
fn sweep(seeds: std::ops::Range<u64>) {
    for seed in seeds {
        let case = Case::from_seed(seed);
        let expected = engine::reference(&case.mesh, case.threshold);
        for engine in engines() {
            let run = |case: &Case| engine.run(&case.mesh, case.threshold, Mode::Reference);
            let Some(found) = run(&case) else { continue };
            if first_difference(&expected, &found).is_none() {
                continue;
            }
            let differs = |case: &Case| {
                let found = run(case).expect("the engine has the mode");
                first_difference(&engine::reference(&case.mesh, case.threshold), &found).is_some()
            };
            let small = shrink::shrink(&case, differs);
            let expected = engine::reference(&small.mesh, small.threshold);
            let found = run(&small).expect("the engine has the mode");
            let what = format!("{}, seed {seed}", engine.name());
            assert_equal(&what, &small.mesh, small.threshold, &expected, &found);
        }
    }
}

#[test]
fn random_meshes() {
    sweep(0..50_000);
}

/// Runs the seeds `first..last` of the variable DARBOUX_SWEEP, or a million.
#[test]
#[ignore = "long"]
fn many_random_meshes() {
    let range = std::env::var("DARBOUX_SWEEP").unwrap_or_else(|_| "50000..1000000".into());
    let (first, last) = range.split_once("..").expect("first..last");
    sweep(first.parse().expect("a number")..last.parse().expect("a number"));
}

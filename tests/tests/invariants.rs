//! Invariants on random meshes.

use darboux_tests::{Case, all_modes, split_and_plan};

fn sweep(seeds: std::ops::Range<u64>) {
    for seed in seeds {
        let case = Case::from_seed(seed);
        if let Err(broken) = all_modes(&case).and_then(|()| split_and_plan(&case)) {
            panic!("seed {seed}: {broken}\nthresholds {:?}\n{}", case.threshold, case.mesh.to_text());
        }
    }
}

#[test]
fn random_meshes() {
    sweep(0..30_000);
}

#[test]
#[ignore = "long"]
fn many_random_meshes() {
    sweep(30_000..1_000_000);
}

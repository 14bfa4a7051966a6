//! Every engine on every collected mesh, in every mode.

use darboux::Mode;
use darboux_tests::corpus::corpus;
use darboux_tests::{Case, all_modes, assert_equal, engine, engines};

#[test]
fn every_engine_gives_the_reference_s_bits() {
    let corpus = corpus();
    for specimen in &corpus {
        for &threshold in &specimen.thresholds {
            let expected = engine::reference(&specimen.mesh, threshold);
            for engine in engines() {
                let Some(found) = engine.run(&specimen.mesh, threshold, Mode::Reference) else { continue };
                let what = format!("{}: {} ({})", engine.name(), specimen.name, specimen.title);
                assert_equal(&what, &specimen.mesh, threshold, &expected, &found);
            }
        }
    }
    println!("{} meshes", corpus.len());
}

#[test]
fn every_mode_keeps_its_promise() {
    for specimen in corpus() {
        for threshold in specimen.thresholds {
            let case = Case { mesh: specimen.mesh.clone(), threshold };
            if let Err(broken) = all_modes(&case) {
                panic!("{} ({}), {threshold} degrees: {broken}", specimen.name, specimen.title);
            }
        }
    }
}

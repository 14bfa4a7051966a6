//! Fuzzes meshes: every engine returns the reference's bits, and every mode keeps its invariants.

#![no_main]

use darboux::Mode;
use darboux_tests::{Case, all_modes, assert_equal, engine, engines};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let case = Case::from_bytes(bytes);
    let Case { mesh, threshold } = &case;
    let expected = engine::reference(mesh, *threshold);
    for engine in engines() {
        if let Some(found) = engine.run(mesh, *threshold, Mode::Reference) {
            assert_equal(engine.name(), mesh, *threshold, &expected, &found);
        }
    }
    if let Err(broken) = all_modes(&case) {
        panic!("{broken}\nthresholds {threshold:?}\n{}", mesh.to_text());
    }
});

//! Every engine on every case of the conformance suite, in every mode.

use darboux::{Frame, Mode};
use darboux_tests::corpus::{CorpusCase, all_cases};
use darboux_tests::{Case, all_modes, assert_equal, compare, engine, engines};

/// The suite is compared with mikktspace.c itself, so that a wrong edit of a case is found.
#[test]
fn expected_values_are_the_reference_s() {
    for CorpusCase { name, mesh, threshold, expected, .. } in all_cases() {
        let expected = expected.unwrap_or_else(|| panic!("{name} has no expected values"));
        let found = engine::reference(&mesh, threshold);
        assert_eq!(expected.tangents.len(), found.len(), "{name}");
        for (corner, found) in found.iter().enumerate() {
            let [x, y, z, sign] = expected.tangents[corner];
            let (bitangent, magnitude) = (expected.bitangents[corner], expected.magnitudes[corner]);
            let frame = Frame { tangent: [x, y, z], bitangent, magnitude, sign };
            let same = found.as_ref().is_none_or(|found| compare::bits(found) == compare::bits(&frame));
            assert!(same, "{name}, corner {corner}: {found:?}, the file has {frame:?}");
        }
    }
}

#[test]
fn every_engine_gives_the_reference_s_bits() {
    let corpus = all_cases();
    for CorpusCase { name, shows, mesh, threshold, .. } in &corpus {
        let expected = engine::reference(mesh, *threshold);
        for engine in engines() {
            let Some(found) = engine.run(mesh, *threshold, Mode::Reference) else { continue };
            let what = format!("{}: {name} ({shows})", engine.name());
            assert_equal(&what, mesh, *threshold, &expected, &found);
        }
    }
    println!("{} meshes", corpus.len());
}

#[test]
fn every_mode_keeps_its_promise() {
    for CorpusCase { name, shows, mesh, threshold, .. } in all_cases() {
        let case = Case { mesh, threshold };
        if let Err(broken) = all_modes(&case) {
            panic!("{name} ({shows}), {threshold} degrees: {broken}");
        }
    }
}

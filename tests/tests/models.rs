//! Real models compared with the reference, bit for bit: those of the repository, and further ones.

use std::path::{Path, PathBuf};

use darboux::Mode;
use darboux_tests::models::{further_models, meshes, models};
use darboux_tests::{Case, all_modes, assert_equal, engine, engines};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Compares every primitive below `folder`; returns how many primitives and triangles that were.
fn compare(folder: &Path) -> (usize, usize) {
    let (mut primitives, mut triangles) = (0, 0);
    for path in models(folder) {
        for (number, mesh) in meshes(&path) {
            let expected = engine::reference(&mesh, 180.0);
            for engine in engines() {
                if let Some(found) = engine.run(&mesh, 180.0, Mode::Reference) {
                    let what = format!("{}: {}, primitive {number}", engine.name(), path.display());
                    assert_equal(&what, &mesh, 180.0, &expected, &found);
                }
            }
            (primitives, triangles) = (primitives + 1, triangles + mesh.corner_count() / 3);
            if let Err(broken) = all_modes(&Case { mesh, threshold: 180.0 }) {
                panic!("{}, primitive {number}: {broken}", path.display());
            }
        }
    }
    println!("{}: {primitives} primitives, {triangles} triangles", folder.display());
    (primitives, triangles)
}

#[test]
fn the_repository_s_models() {
    let (primitives, _) = compare(&root().join("assets"));
    assert!(primitives > 8, "{primitives} primitives");
}

#[test]
fn further_models_too() {
    let Some(folder) = further_models() else { return };
    let (primitives, _) = compare(&folder);
    assert!(primitives > 100, "{primitives} primitives");
}

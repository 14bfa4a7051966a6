//! Runs `darboux tangents` on every model of the repository and of `DARBOUX_MODELS`, and checks the outputs.

mod common;

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use common::{asset, darboux, text};
use darboux_tests::models::further_models;
use serde_json::Value;

#[test]
fn all_models_of_the_repository_get_their_tangents_and_keep_them() {
    check(&asset("."));
}

#[test]
fn all_further_models_get_their_tangents_and_keep_them() {
    if let Some(folder) = further_models() {
        check(&folder);
    }
}

/// Each primitive that can have tangents has them in the output; a second run has nothing to do and copies
/// every byte.
fn check(folder: &Path) {
    let work = tempfile::tempdir().expect("a temporary folder");
    let (first, second) = (work.path().join("first"), work.path().join("second"));
    let report = run(&["tangents", "--overwrite", text(folder), "--out-dir", text(&first)]);
    let able =
        primitives(&run(&["inspect", text(folder)]), folder, |primitive| primitive["ineligible"].is_null());
    let have =
        primitives(&run(&["inspect", text(&first)]), &first, |primitive| primitive["has_tangents"] == true);
    for file in files(&report) {
        match file["error"].as_str() {
            Some(error) => {
                assert!(error.contains("does not exist"), "only missing files are refused: {error}")
            }
            None => {
                let name = below(file["input"].as_str().expect("a path"), folder);
                // The output of another format than glTF has another name.
                let output = below(file["output"].as_str().expect("a path"), &first);
                let lacks = able[&name].iter().zip(&have[&output]).position(|(&able, &has)| able && !has);
                assert_eq!(lacks, None, "{name}: a primitive could have tangents");
            }
        }
    }
    let again = run(&["tangents", text(&first), "--out-dir", text(&second)]);
    for file in files(&again) {
        assert_eq!(file["status"], "copied", "{file}");
        for written in file["files_written"].as_array().expect("a list") {
            let written = Path::new(written.as_str().expect("a path"));
            let before = first.join(written.strip_prefix(&second).expect("a file below the output's folder"));
            assert!(fs::read(written).ok() == fs::read(&before).ok(), "{} is a copy", written.display());
        }
    }
}

/// The report of a run, in which files may fail.
fn run(arguments: &[&str]) -> Value {
    let run = darboux(&[arguments, &["--json"]].concat());
    assert!(run.code <= 1, "{}", run.stderr);
    run.json()
}

fn files(report: &Value) -> &Vec<Value> {
    report["files"].as_array().expect("a list of files")
}

/// For each file, by its path below the folder, whether `holds` for each primitive.
fn primitives(report: &Value, folder: &Path, holds: fn(&Value) -> bool) -> HashMap<String, Vec<bool>> {
    let good = files(report).iter().filter(|file| file["error"].is_null());
    good.map(|file| {
        let primitives = file["primitives"].as_array().expect("a list of primitives");
        (below(file["input"].as_str().expect("a path"), folder), primitives.iter().map(holds).collect())
    })
    .collect()
}

fn below(path: &str, folder: &Path) -> String {
    text(Path::new(path).strip_prefix(folder).expect("a path below the folder")).to_owned()
}

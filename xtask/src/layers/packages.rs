//! Which package may import which: the table of ARCHITECTURE.md as data, compared with `cargo metadata`.

use std::path::PathBuf;

use serde_json::Value;

use crate::run::{Outcome, output_of, program, root};

/// Each package of this repository, and the packages of this repository that it may import, tests and build
/// scripts included.
const MAY_IMPORT: &[(&str, &[&str])] = &[
    ("darboux", &["darboux-dice"]),
    ("darboux-io", &["darboux", "darboux-dice"]),
    ("darboux-gpu", &["darboux", "darboux-tests"]),
    ("darboux-render", &["darboux", "darboux-io", "darboux-gpu", "darboux-dice"]),
    ("darboux-check", &["darboux", "darboux-io", "darboux-dice", "darboux-tests"]),
    ("darboux-bake", &["darboux", "darboux-io", "darboux-dice", "darboux-tests"]),
    (
        "darboux-cli",
        &[
            "darboux",
            "darboux-io",
            "darboux-check",
            "darboux-bake",
            "darboux-gpu",
            "darboux-render",
            "darboux-cli",
            "darboux-tests",
        ],
    ),
    ("darboux-c", &["darboux", "darboux-tests"]),
    ("darboux-mikktspace", &["darboux"]),
    ("darboux-js", &["darboux", "darboux-io", "darboux-check", "darboux-bake"]),
    ("darboux-viewer", &["darboux", "darboux-io"]),
    ("darboux-python", &["darboux", "darboux-io", "darboux-check", "darboux-bake", "darboux-cli"]),
    ("darboux-dice", &[]),
    ("darboux-tests", &["darboux", "darboux-io", "darboux-dice"]),
    ("darboux-shader-tests", &["darboux", "darboux-dice"]),
    ("darboux-benches", &["darboux", "darboux-check", "darboux-io", "darboux-tests"]),
    (
        "darboux-fuzz",
        &["darboux", "darboux-bake", "darboux-c", "darboux-check", "darboux-io", "darboux-tests"],
    ),
    ("xtask", &[]),
];

/// Packages that published packages may import in their tests only.
const ONLY_IN_TESTS: &[&str] = &["darboux-dice", "darboux-tests"];

/// The packages of the workspace and of `fuzz`, as `cargo metadata` describes them.
pub fn all() -> Result<Vec<Value>, String> {
    let mut packages = of_manifest("Cargo.toml")?;
    if root().join("fuzz/Cargo.toml").exists() {
        packages.extend(of_manifest("fuzz/Cargo.toml")?);
    }
    Ok(packages)
}

/// Errors: a package imports one that it may not, the core requires a third-party crate, or a package has no
/// row in the table.
pub fn check(packages: &[Value]) -> Outcome {
    let violations: Vec<String> = packages.iter().flat_map(violations).collect();
    if violations.is_empty() {
        println!("{} packages import only what they may", packages.len());
        Ok(())
    } else {
        Err(violations.join("; "))
    }
}

/// The root files of all libraries, programs, examples, tests and build scripts.
pub fn targets(packages: &[Value]) -> Vec<PathBuf> {
    let targets = packages.iter().filter_map(|package| package["targets"].as_array()).flatten();
    let mut paths: Vec<PathBuf> =
        targets.filter_map(|target| target["src_path"].as_str()).map(PathBuf::from).collect();
    paths.sort();
    paths
}

fn of_manifest(manifest: &str) -> Result<Vec<Value>, String> {
    let mut metadata = program("cargo metadata --format-version 1 --no-deps --manifest-path");
    let text = output_of(metadata.arg(manifest))?;
    let mut metadata: Value =
        serde_json::from_slice(&text).map_err(|error| format!("cargo metadata: {error}"))?;
    match metadata["packages"].take() {
        Value::Array(packages) => Ok(packages),
        _ => Err("cargo metadata lists no packages".into()),
    }
}

fn violations(package: &Value) -> Vec<String> {
    let name = package["name"].as_str().unwrap_or_default();
    let Some(&(_, allowed)) = MAY_IMPORT.iter().find(|row| row.0 == name) else {
        return vec![format!("{name} has no row in xtask/src/layers/packages.rs")];
    };
    let dependencies = package["dependencies"].as_array().map(Vec::as_slice).unwrap_or_default();
    let is_published = package["publish"].is_null();
    let violation = |dependency| violation((name, is_published), allowed, dependency);
    dependencies.iter().filter_map(violation).collect()
}

fn violation((name, is_published): (&str, bool), allowed: &[&str], dependency: &Value) -> Option<String> {
    let import = dependency["name"].as_str().unwrap_or_default();
    if is_published && ONLY_IN_TESTS.contains(&import) && dependency["kind"] != "dev" {
        return Some(format!("{name} may import {import} in its tests only"));
    }
    if MAY_IMPORT.iter().any(|row| row.0 == import) {
        return (!allowed.contains(&import)).then(|| format!("{name} may not import {import}"));
    }
    let required = dependency["kind"].is_null() && dependency["optional"] == false;
    (name == "darboux" && required).then(|| format!("the core may not require {import}"))
}

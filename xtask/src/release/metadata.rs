//! The fields that registries show.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::work::VERSION;
use crate::run::{Outcome, output_of, program, root};

/// Errors: a field, a README or the changelog's section for this version is missing.
pub fn check() -> Outcome {
    let mut problems = Vec::new();
    for package in published()? {
        problems.extend(crate_problems(&package));
    }
    let pyproject = read("bindings/python/pyproject.toml")?;
    for field in ["description", "readme", "requires-python", "license", "keywords", "classifiers"] {
        if !pyproject.lines().any(|line| line.starts_with(&format!("{field} = "))) {
            problems.push(format!("bindings/python/pyproject.toml has no {field}"));
        }
    }
    let npm: Value = serde_json::from_str(&read("bindings/js/lib/package.json")?)
        .map_err(|error| format!("bindings/js/lib/package.json: {error}"))?;
    for field in ["description", "keywords", "license", "exports"] {
        if npm[field].is_null() {
            problems.push(format!("bindings/js/lib/package.json has no {field}"));
        }
    }
    let python_licences = ["bindings/python/LICENSE-MIT", "bindings/python/LICENSE-APACHE"];
    for file in ["bindings/python/README.md", "bindings/js/README.md"].into_iter().chain(python_licences) {
        if !root().join(file).exists() {
            problems.push(format!("{file} is missing"));
        }
    }
    if !has_section(&read("CHANGELOG.md")?) {
        problems.push(format!("the first section of CHANGELOG.md must be \"## {VERSION}\""));
    }
    if problems.is_empty() { Ok(()) } else { Err(problems.join("; ")) }
}

/// The packages that go to crates.io, in an order in which each comes after those that it needs.
pub fn published() -> Result<Vec<Value>, String> {
    let text = output_of(&mut program("cargo metadata --format-version 1 --no-deps"))?;
    let mut metadata: Value =
        serde_json::from_slice(&text).map_err(|error| format!("cargo metadata: {error}"))?;
    let Value::Array(mut packages) = metadata["packages"].take() else {
        return Err("cargo metadata lists no packages".into());
    };
    packages.retain(|package| package["publish"].is_null());
    let mut ordered = Vec::new();
    while !packages.is_empty() {
        let is_ready = |package: &Value| !packages.iter().any(|other| needs(package, other));
        let next =
            packages.iter().position(is_ready).ok_or("the packages depend on each other in a cycle")?;
        ordered.push(packages.remove(next));
    }
    Ok(ordered)
}

/// True if `package` depends on `other`, outside of its tests.
fn needs(package: &Value, other: &Value) -> bool {
    let dependencies = package["dependencies"].as_array().into_iter().flatten();
    let mut names = dependencies.filter(|one| one["kind"] != "dev").map(|one| &one["name"]);
    names.any(|needed| *needed == other["name"])
}

/// The name of a package.
pub fn name(package: &Value) -> &str {
    package["name"].as_str().unwrap_or_default()
}

fn crate_problems(package: &Value) -> Vec<String> {
    let is_missing = |field: &&str| match &package[*field] {
        Value::Null => true,
        Value::Array(list) => list.is_empty(),
        Value::String(text) => text.is_empty(),
        _ => false,
    };
    let fields = ["description", "license", "readme", "keywords", "categories", "rust_version"];
    let mut problems: Vec<String> = fields
        .iter()
        .filter(|field| is_missing(field))
        .map(|field| format!("{} has no {field}", name(package)))
        .collect();
    if package["keywords"].as_array().is_some_and(|keywords| keywords.len() > 5) {
        problems.push(format!("{} has more than the five keywords that crates.io takes", name(package)));
    }
    // Both licences want their text to go with every copy. They are links, which cargo packages as files.
    let folder = package["manifest_path"].as_str().map(Path::new).and_then(Path::parent).unwrap_or(root());
    let licences =
        ["LICENSE-MIT", "LICENSE-APACHE"].into_iter().filter(|licence| !folder.join(licence).exists());
    problems.extend(licences.map(|licence| format!("{} has no {licence}", name(package))));
    if package["version"] != VERSION {
        problems.push(format!("{} has another version than {VERSION}", name(package)));
    }
    problems
}

fn has_section(changelog: &str) -> bool {
    let first = changelog.lines().find_map(|line| line.strip_prefix("## ")).unwrap_or_default();
    first.split(' ').next() == Some(VERSION)
}

fn read(name: &str) -> Result<String, String> {
    let path: &Path = &root().join(name);
    fs::read_to_string(path).map_err(|error| format!("{name} cannot be read: {error}"))
}

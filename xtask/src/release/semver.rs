//! Semantic versioning: `cargo semver-checks` compares the libraries with those of an earlier release.

use crate::api;
use crate::progress::step;
use crate::run::{Outcome, program, run, works};

const TOOL_VERSION: &str = "0.51.0";

/// Errors: the API has changed by more than the version says; the tag is missing.
pub fn check(tag: &str) -> Outcome {
    if !works(&mut program("cargo semver-checks --version")) {
        let install = format!("cargo install --quiet --locked cargo-semver-checks --version {TOOL_VERSION}");
        step("install cargo-semver-checks, once", || run(&mut program(&install)))?;
    }
    let mut check = program("cargo semver-checks --all-features --baseline-rev");
    check.arg(tag);
    for package in api::PACKAGES {
        check.args(["--package", package]);
    }
    run(&mut check)
}

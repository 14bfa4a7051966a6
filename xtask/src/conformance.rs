//! `cargo xtask conformance`: the public suite in `conformance/`. The suite needs only Python; this runs what needs Rust beside it.

use std::path::PathBuf;
use std::process::Command;

use crate::run::{Outcome, program, root, run, target_folder, works};

/// `cargo xtask conformance`: runs every adapter that this machine has, and rebuilds the table and the page.
///
/// `--regenerate` writes the expected values of all cases instead, and `--new` proposes cases from a differential run.
pub fn task(words: &[&str]) -> Outcome {
    match words {
        ["--regenerate"] => {
            compute_reference()?;
            run(program("python3 conformance/regenerate.py").arg(folder("reference")?))
        }
        ["--new", rest @ ..] => {
            compute_reference()?;
            let mut proposer = program("python3 conformance/propose.py");
            run(proposer.arg(folder("")?).args(rest).env("DARBOUX_TOOL", tool()?))
        }
        names => {
            compute_reference()?;
            let mut runner = program("python3 conformance/run.py");
            run(runner.arg(folder("")?).args(names).envs(interfaces()?))?;
            run(&mut program("python3 conformance/page.py"))
        }
    }
}

/// The step of `ci`: the tests of the judge, the expected values of every case, and every mode of Darboux.
pub fn check() -> Outcome {
    if !works(&mut program("python3 --version")) {
        println!("skipped: the conformance suite needs python3");
        return Ok(());
    }
    run(&mut program("python3 -m unittest discover --start-directory conformance/tests"))?;
    compute_reference()?;
    run(program("python3 conformance/regenerate.py").arg(folder("reference")?).arg("--check"))?;
    for (mode, level) in [("reference", "bits"), ("repaired", "angle"), ("corrected", "angle")] {
        let results = folder(&format!("darboux-{mode}"))?;
        run(computer()?.arg(folder("cases")?).arg(&results).arg(mode))?;
        run(program("python3 conformance/judge.py").arg(&results).args(["--level", level]))?;
    }
    Ok(())
}

/// The step of `ci --full`: the table of mutations, for which every wrong variant runs on every case.
pub fn check_mutations() -> Outcome {
    run(&mut program("python3 conformance/mutations.py"))
}

/// Writes every case with its vertices, and the results of mikktspace.c.
fn compute_reference() -> Outcome {
    run(&mut program("cargo build --quiet --package darboux-tests --bin conformance"))?;
    let cases = folder("cases")?;
    run(program("python3 conformance/generate.py").arg(&cases).arg("--all"))?;
    run(computer()?.arg(cases).arg(folder("reference")?))
}

/// The environment variables with which the adapters of our own interfaces find them. Interfaces that are not built are left out.
fn interfaces() -> Result<Vec<(&'static str, PathBuf)>, String> {
    let target = target_folder()?;
    let built = [
        ("DARBOUX_TOOL", tool()?),
        ("DARBOUX_C", target.join("dist-c/darboux")),
        ("DARBOUX_PYTHON", target.join("python/bin/python")),
        ("DARBOUX_NPM", target.join("dist-js/darboux")),
    ];
    Ok(built.into_iter().filter(|(_, path)| path.exists()).collect())
}

/// The program that computes cases with mikktspace.c and with Darboux: `CASES RESULTS [MODE]`.
fn computer() -> Result<Command, String> {
    let mut command = Command::new(tool()?);
    command.current_dir(root());
    Ok(command)
}

fn tool() -> Result<PathBuf, String> {
    Ok(target_folder()?.join("debug/conformance"))
}

fn folder(name: &str) -> Result<PathBuf, String> {
    Ok(target_folder()?.join("conformance").join(name))
}

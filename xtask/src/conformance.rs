//! `cargo xtask conformance`: the public suite in `conformance/`. The suite needs only Python; this runs what
//! needs Rust beside it.

use std::path::PathBuf;
use std::process::Command;

use crate::run::{Outcome, program, root, run, target_folder, works};
use crate::{dist_c, dist_js, python};

/// `cargo xtask conformance`: runs every adapter that this machine has, and rebuilds the table and the page.
///
/// `--wrong` runs them on wrong inputs and as wrong builds instead, `--regenerate` writes the expected values
/// of all cases, and `--new` proposes cases from a differential run. Our own interfaces are built first where
/// their adapters are among those that run.
pub fn task(words: &[&str]) -> Outcome {
    match words {
        ["--regenerate"] => {
            compute_reference()?;
            run(program("python3 conformance/regenerate.py").arg(folder("reference")?))
        }
        ["--new", rest @ ..] => {
            compute_reference()?;
            let mut proposer = program("python3 conformance/propose.py");
            run(proposer.arg(folder("")?).args(rest).envs(interfaces(rest)?))
        }
        ["--wrong", names @ ..] => adapters("python3 conformance/wrong.py", names),
        names => adapters("python3 conformance/run.py", names),
    }
}

/// Runs a script on adapters, and rebuilds the table and the page.
fn adapters(script: &str, names: &[&str]) -> Outcome {
    compute_reference()?;
    let done = run(program(script).arg(folder("")?).args(names).envs(interfaces(names)?));
    done.and(run(&mut program("python3 conformance/page.py")))
}

/// The step of `ci`: the tests of the judge, the expected values of every case, and every mode of Darboux.
pub fn check() -> Outcome {
    if !works(&mut program("python3 --version")) {
        println!("skipped: the conformance suite needs python3");
        return Ok(());
    }
    run(&mut program("python3 -m unittest discover --start-directory conformance/tests"))?;
    run(&mut program("python3 conformance/page.py --check"))?;
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

/// The environment variables with which the adapters of our own interfaces find them. The libraries of the
/// named adapters are built; those of all adapters if none is named; interfaces that cannot be built here are
/// left out, and the scripts say which adapters that skips.
fn interfaces(names: &[&str]) -> Result<Vec<(&'static str, PathBuf)>, String> {
    let target = target_folder()?;
    let built = [
        ("DARBOUX_TOOL", tool()?),
        ("DARBOUX_GPU", target.join("debug/examples/conformance")),
        ("DARBOUX_C", target.join("dist-c/darboux")),
        ("DARBOUX_PYTHON", target.join("python/bin/python")),
        ("DARBOUX_NPM", target.join("dist-js/darboux")),
    ];
    let is_wanted = |own: &[&str]| names.is_empty() || own.iter().any(|name| names.contains(name));
    for (own, build) in BUILDS {
        if is_wanted(own) {
            build().unwrap_or_else(|message| println!("skipped: {}: {message}", own.join(", ")));
        }
    }
    Ok(built.into_iter().filter(|(_, path)| path.exists()).collect())
}

/// Adapters of our own, and what builds the interface that they run.
type Build = (&'static [&'static str], fn() -> Outcome);

const BUILDS: [Build; 4] = [
    (&["darboux-gpu"], || {
        run(&mut program("cargo build --quiet --package darboux-gpu --example conformance"))
    }),
    (&["darboux-c"], dist_c::make),
    (&["darboux-python"], || python::with_package().map(|_| ())),
    (&["darboux-npm", "darboux-webgpu"], || dist_js::make(dist_js::Build::Release)),
];

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

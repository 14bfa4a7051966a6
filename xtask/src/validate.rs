//! The command's outputs for all models, checked by tools that are not ours: the Khronos validator and glTF-Transform.

use std::fs;

use crate::run::{Outcome, program, root, run, shown, works};

/// What to do on a machine without node or npm.
#[derive(Clone, Copy)]
pub enum WithoutNpm {
    /// Say so and go on.
    Skip,
    /// Stop.
    Fail,
}

/// Folders of models: ours, and a larger set that may lie beside the repository.
const MODELS: &[&str] = &["assets", "../shared/assets"];

/// Adds tangents to every model and checks the outputs with validate/check.mjs, which says what is checked.
pub fn all_models(without_npm: WithoutNpm) -> Outcome {
    if !works(&mut program("npm --version")) || !works(&mut program("node --version")) {
        let message = "node and npm are needed to check the models; install Node.js 20 or newer";
        return match without_npm {
            WithoutNpm::Fail => Err(message.into()),
            WithoutNpm::Skip => {
                println!("skipped: {message}");
                Ok(())
            }
        };
    }
    install()?;
    run(&mut program("cargo build --quiet --package darboux-cli"))?;
    MODELS.iter().enumerate().try_for_each(|(number, folder)| check(folder, number))
}

/// Installs the tools at the versions of the lock file, unless they are there.
fn install() -> Outcome {
    let folder = root().join("xtask/validate");
    let modified = |name| fs::metadata(folder.join(name)).and_then(|file| file.modified()).ok();
    let installed = modified("node_modules/.package-lock.json");
    if installed.is_some() && installed >= modified("package-lock.json") {
        return Ok(());
    }
    run(program("npm ci --no-audit --no-fund --loglevel=error").current_dir(folder))
}

fn check(folder: &str, number: usize) -> Outcome {
    if !root().join(folder).is_dir() {
        println!("skipped: {folder} is absent");
        return Ok(());
    }
    let work = root().join(format!("target/models/{number}"));
    if work.exists() {
        fs::remove_dir_all(&work)
            .map_err(|error| format!("{} cannot be removed: {error}", work.display()))?;
    }
    fs::create_dir_all(&work).map_err(|error| format!("{} cannot be made: {error}", work.display()))?;
    let report = work.join("report.json");
    let mut tangents = program("target/debug/darboux tangents --overwrite --quiet --json");
    tangents.arg(folder).arg("--out-dir").arg(work.join("out"));
    let output = tangents.output().map_err(|error| format!("{} cannot start: {error}", shown(&tangents)))?;
    fs::write(&report, output.stdout)
        .map_err(|error| format!("{} cannot be written: {error}", report.display()))?;
    println!("{folder}:");
    run(program("node xtask/validate/check.mjs").arg(report))
}

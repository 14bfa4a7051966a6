//! Checks the command's outputs for all models with independent tools: the Khronos validator and
//! glTF-Transform.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use crate::npm;
use crate::run::{Outcome, files_below, further_models, program, root, run, shown, works};

/// The behaviour on a machine without node or npm.
#[derive(Clone, Copy)]
pub enum WithoutNpm {
    /// Print that the step is skipped.
    Skip,
    /// Fail.
    Fail,
}

/// Adds tangents to every model and checks the outputs with validate/check.mjs.
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
    npm::install("the validator", &root().join("xtask/validate"))?;
    run(&mut program("cargo build --quiet --package darboux-cli --features full"))?;
    check(&root().join("assets"), "assets")?;
    match further_models() {
        Some(folder) => check(&folder, "further"),
        None => {
            println!("skipped: no further models; set DARBOUX_MODELS to a folder of .gltf and .glb files");
            Ok(())
        }
    }
}

/// Runs the command on a folder of models, and on each model with output to the other container, and checks
/// all outputs.
fn check(folder: &Path, name: &str) -> Outcome {
    let work = root().join("target/models").join(name);
    if work.exists() {
        fs::remove_dir_all(&work)
            .map_err(|error| format!("{} cannot be removed: {error}", work.display()))?;
    }
    let out = work.join("same");
    let mut reports = vec![tangents(&[folder.as_ref(), "--out-dir".as_ref(), out.as_os_str()], &work, 0)?];
    for model in files_below(folder)? {
        let other = match model.extension().and_then(|extension| extension.to_str()) {
            Some("glb") => "gltf",
            Some("gltf") => "glb",
            _ => continue,
        };
        let number = reports.len();
        let folder = work.join(format!("other/{number}"));
        fs::create_dir_all(&folder)
            .map_err(|error| format!("{} cannot be made: {error}", folder.display()))?;
        let out = folder.join(format!("model.{other}"));
        reports.push(tangents(&[model.as_os_str(), "-o".as_ref(), out.as_os_str()], &work, number)?);
    }
    println!("{}:", folder.display());
    run(program("node xtask/validate/check.mjs").args(reports)).map_err(|_| {
        format!("outputs for the models in {} are not as they must be; see above", folder.display())
    })
}

/// Runs `darboux tangents --overwrite` with these arguments; returns the path of its JSON report, which also
/// lists failures.
fn tangents(arguments: &[&OsStr], work: &Path, number: usize) -> Result<PathBuf, String> {
    let mut command = program("target/debug/darboux tangents --overwrite --quiet --json");
    command.args(arguments).stderr(Stdio::null());
    let output = command.output().map_err(|error| format!("{} cannot start: {error}", shown(&command)))?;
    let report = work.join(format!("{number}.json"));
    let written = fs::create_dir_all(work).and_then(|()| fs::write(&report, output.stdout));
    written.map_err(|error| format!("{} cannot be written: {error}", report.display()))?;
    Ok(report)
}

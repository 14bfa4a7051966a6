//! How much memory an engine needs besides input and output: by the resident peak of a child process that runs it once.
//!
//! Allocations are counted by the kernel, so that C and Rust are measured alike.

use std::fs;
use std::path::Path;
use std::process::Command;

use darboux_tests::OwnedMesh;

use crate::engines::Engine;
use crate::run::Tangent;

/// Bytes that one call of an engine needs, measured in a child process; none where the system cannot tell.
pub fn of_a_child(engine: &str, mesh: &str, quick: bool, models: &Path) -> Option<f64> {
    let mut command = Command::new(std::env::current_exe().ok()?);
    command.args(["--engines", engine, "--meshes", mesh, "--only-memory", "--models"]).arg(models);
    if quick {
        command.arg("--quick");
    }
    // What is freed goes back to the system at once, or the mesh's making would leave room that the engine then uses unseen.
    command.env("GLIBC_TUNABLES", "glibc.malloc.mmap_threshold=65536:glibc.malloc.trim_threshold=65536");
    let output = command.output().ok()?;
    String::from_utf8(output.stdout).ok()?.trim().parse().ok()
}

/// What the child does: runs the engine once and gives the bytes by which the peak rose, less the output's.
pub fn of_this_process(engine: &Engine, mesh: &OwnedMesh) -> Option<f64> {
    let mut run = engine.start(mesh, None).ok()?;
    // Resets the peak (Linux, Documentation/filesystems/proc.rst).
    fs::write("/proc/self/clear_refs", "5").ok()?;
    let before = status("VmRSS:")?;
    run.run(1).ok()?;
    let output = run.output_len() * size_of::<Tangent>();
    Some((status("VmHWM:")? - before - output as f64).max(0.0))
}

/// A quantity of /proc/self/status in bytes.
fn status(name: &str) -> Option<f64> {
    let text = fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    Some(1024.0 * line.trim().strip_suffix(" kB")?.parse::<f64>().ok()?)
}

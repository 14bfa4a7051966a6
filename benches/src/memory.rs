//! Measures the memory that an engine needs besides input and output: the peak resident memory of a child process that runs it once.
//!
//! Allocations are counted by the kernel, so that C and Rust are measured alike.

use std::fs;
use std::path::Path;
use std::process::Command;

use darboux_tests::OwnedMesh;

use crate::engines::Engine;
use crate::run::Tangent;

/// The bytes that one call of an engine needs, measured in a child process; `None` if the system does not report them.
pub fn of_a_child(engine: &str, mesh: &str, quick: bool, models: Option<&Path>) -> Option<f64> {
    let mut command = Command::new(std::env::current_exe().ok()?);
    command.args(["--engines", engine, "--meshes", mesh, "--only-memory"]);
    if let Some(models) = models {
        command.arg("--models").arg(models);
    }
    if quick {
        command.arg("--quick");
    }
    // Freed memory returns to the system at once. Otherwise the engine could reuse memory from creating the mesh, and it would not be counted.
    command.env("GLIBC_TUNABLES", "glibc.malloc.mmap_threshold=65536:glibc.malloc.trim_threshold=65536");
    let output = command.output().ok()?;
    String::from_utf8(output.stdout).ok()?.trim().parse().ok()
}

/// The child process: runs the engine once and returns the growth of the peak in bytes, without the output.
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

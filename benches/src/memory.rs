//! Measures the memory that an engine needs besides input and output: the peak resident memory of a child
//! process that runs it once.
//!
//! Allocations are counted by the kernel, so that C and Rust are measured alike.

use std::fs;
use std::path::Path;
use std::process::Command;

use darboux_tests::OwnedMesh;

use crate::engines::Engine;
use crate::run::{Tangent, Time};

/// The bytes that one call of an engine needs, measured in a child process; `None` if the system does not
/// report them.
pub fn of_a_child(engine: &str, mesh: &str, quick: bool, models: Option<&Path>) -> Option<f64> {
    let mut command = Command::new(std::env::current_exe().ok()?);
    command.args(["--engines", engine, "--meshes", mesh, "--only-memory"]);
    if let Some(models) = models {
        command.arg("--models").arg(models);
    }
    if quick {
        command.arg("--quick");
    }
    let output = returning_freed(&mut command).output().ok()?;
    String::from_utf8(output.stdout).ok()?.trim().parse().ok()
}

/// Makes a child process return freed memory to the system at once. Otherwise what is measured could reuse
/// memory from creating its input, and that would not be counted.
pub fn returning_freed(command: &mut Command) -> &mut Command {
    command.env("GLIBC_TUNABLES", "glibc.malloc.mmap_threshold=65536:glibc.malloc.trim_threshold=65536")
}

/// The growth of the peak resident memory of this process while a task runs, in bytes.
pub fn growth(task: impl FnOnce()) -> Option<f64> {
    // Resets the peak (Linux, Documentation/filesystems/proc.rst).
    fs::write("/proc/self/clear_refs", "5").ok()?;
    let before = status("VmRSS:")?;
    task();
    Some(status("VmHWM:")? - before)
}

/// The child process: runs the engine once and returns the growth of the peak in bytes, without the output.
pub fn of_this_process(engine: &Engine, mesh: &OwnedMesh) -> Option<f64> {
    let mut run = engine.start(mesh, None).ok()?;
    let mut result = Ok(Time::default());
    let growth = growth(|| result = run.run(1))?;
    result.ok()?;
    let output = run.output_len() * size_of::<Tangent>();
    Some((growth - output as f64).max(0.0))
}

/// A quantity of /proc/self/status in bytes.
fn status(name: &str) -> Option<f64> {
    let text = fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    Some(1024.0 * line.trim().strip_suffix(" kB")?.parse::<f64>().ok()?)
}

//! Counts instructions per triangle with callgrind. Unlike times, the counts do not depend on other programs.

use std::process::Command;

use crate::engines::Engine;
use crate::meshes::{self, Size};

/// The meshes that are counted, of fifty thousand triangles each; `small` has 5,000.
pub const MESHES: [&str; 6] = ["grid", "quads", "sphere", "soup", "charts", "small"];

/// Instructions per triangle of one engine.
pub struct Counts {
    /// The engine.
    pub engine: &'static str,
    /// The count on each of [`MESHES`]; none where a run fails, or the engine does not take the mesh.
    pub of_mesh: Vec<Option<f64>>,
}

/// Counts every engine that runs in this process. Errors: valgrind is not installed.
pub fn count(engines: &[Engine]) -> Result<Vec<Counts>, String> {
    let found = Command::new("valgrind").arg("--version").output();
    found.map_err(|error| format!("valgrind is needed to count instructions and cannot start: {error}"))?;
    let native = engines.iter().filter(|engine| engine.is_native());
    let of_mesh = |engine: &Engine| MESHES.iter().map(|mesh| per_triangle(engine, mesh)).collect();
    Ok(native.map(|engine| Counts { engine: engine.name, of_mesh: of_mesh(engine) }).collect())
}

/// The difference between three calls and one, so that creating the mesh and the set-up of the first call do
/// not count.
fn per_triangle(engine: &Engine, name: &str) -> Option<f64> {
    let mesh = meshes::make(name, Size::QUICK).filter(|mesh| engine.takes(&mesh.mesh))?;
    eprintln!("counting {} on {name}", engine.name);
    let calls = |count| collected(engine.name, name, count);
    Some((calls(3)? - calls(1)?) / (2 * mesh.triangles()) as f64)
}

/// The instructions of a child process that calls an engine `calls` times.
fn collected(engine: &str, mesh: &str, calls: usize) -> Option<f64> {
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(std::env::current_exe().ok()?);
    command.args(["--quick", "--engines", engine, "--meshes", mesh, "--only-calls", &calls.to_string()]);
    let output = command.output().ok().filter(|output| output.status.success())?;
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    let line = text.lines().find_map(|line| line.split_once("Collected : "))?;
    line.1.trim().parse().ok()
}

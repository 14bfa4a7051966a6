//! `cargo xtask bench --files`: tangents for a whole file, by the command and by other tools, in turns.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::npm;
use crate::run::{Outcome, output_of, program, root, run, target_folder, works};

/// Each tool runs so many times.
const ROUNDS: usize = 7;

/// Prints wall time, processor time and memory of each tool for a grid of `2 * side * side` triangles.
/// `words`: the side, 708 by default.
pub fn bench(words: &[&str]) -> Outcome {
    let side = words.first().unwrap_or(&"708");
    if !works(&mut program("/usr/bin/time --version")) || !works(&mut program("npm --version")) {
        return Err("bench --files needs GNU time (Debian: time) and Node.js with npm".into());
    }
    let folder = target_folder()?.join("bench-files");
    let tools = tools(&folder)?;
    let line =
        "cargo run --quiet --release --package darboux-io --features darboux/parallel --example measure --";
    run(program(line).arg(&folder).arg(side))?;
    let mut runs = vec![Vec::new(); tools.len()];
    for _ in 0..ROUNDS {
        for (tool, runs) in tools.iter().zip(&mut runs) {
            runs.push(tool.time(&folder)?);
        }
    }
    println!(
        "tool, version: wall time (least to most), processor time, both in seconds; peak of memory; size of \
         the output"
    );
    for (tool, mut runs) in tools.iter().zip(runs) {
        runs.sort_by(|a, b| a.wall.total_cmp(&b.wall));
        let (first, middle, last) = (&runs[0], &runs[ROUNDS / 2], &runs[ROUNDS - 1]);
        println!(
            "{}: {:.2} ({:.2} to {:.2}), {:.2}; {:.0} MB; {:.1} MB",
            tool.name, middle.wall, first.wall, last.wall, middle.processor, middle.memory, middle.output
        );
    }
    Ok(())
}

/// A tool that writes `out.glb` from `grid.glb`.
struct Tool {
    name: String,
    /// The program and its arguments.
    line: Vec<String>,
}

/// What one run took.
#[derive(Clone, Debug)]
struct Run {
    /// Seconds.
    wall: f64,
    processor: f64,
    /// Megabytes.
    memory: f64,
    output: f64,
}

/// The command, on all threads and on one, and the tools of npm.
fn tools(folder: &Path) -> Result<Vec<Tool>, String> {
    let packages = packages(folder)?;
    run(&mut program("cargo build --quiet --release --package darboux-cli"))?;
    let darboux = target_folder()?.join("release/darboux").display().to_string();
    let tool = |name: &str, program: &str, rest: &str| Tool {
        name: name.to_owned(),
        line: std::iter::once(program).chain(rest.split(' ')).map(str::to_owned).collect(),
    };
    let of_npm = |name: &str| packages.join("node_modules/.bin").join(name).display().to_string();
    Ok(vec![
        tool("darboux", &darboux, "tangents --quiet --overwrite --force grid.glb -o out.glb"),
        tool("darboux, one thread", &darboux, "tangents --quiet --overwrite --force grid.glb -o out.glb"),
        tool("gltfpack -gt -noq", &of_npm("gltfpack"), "-gt -noq -i grid.glb -o out.glb"),
        tool("gltf-transform", &of_npm("gltf-transform"), "tangents grid.glb out.glb"),
    ])
}

/// Installs the packages of benches/files at the versions of its lock file.
fn packages(folder: &Path) -> Result<PathBuf, String> {
    let to = folder.join("npm");
    let cannot_write = |error| format!("{} cannot be written: {error}", to.display());
    fs::create_dir_all(&to).map_err(cannot_write)?;
    for name in ["package.json", "package-lock.json"] {
        fs::copy(root().join("benches/files").join(name), to.join(name)).map_err(cannot_write)?;
    }
    npm::install("the benchmark of files", &to)?;
    Ok(to)
}

impl Tool {
    fn time(&self, folder: &Path) -> Result<Run, String> {
        let mut command = Command::new("/usr/bin/time");
        command.args(["-f", "%e %U %S %M", "-o", "time.txt"]).args(&self.line).current_dir(folder);
        output_of(&mut command)?;
        let unreadable = |what: &Path| format!("{} did not write {}", self.name, what.display());
        let (times, output) = (folder.join("time.txt"), folder.join("out.glb"));
        let text = fs::read_to_string(&times).map_err(|_| unreadable(&times))?;
        let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let [wall, user, system, kilobytes] = numbers[..] else { return Err(unreadable(&times)) };
        let size = fs::metadata(&output).map_err(|_| unreadable(&output))?.len();
        fs::remove_file(&output).map_err(|_| unreadable(&output))?;
        let (memory, output) = (kilobytes / 1e3, size as f64 / 1e6);
        Ok(Run { wall, processor: user + system, memory, output })
    }
}

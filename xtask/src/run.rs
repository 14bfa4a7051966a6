//! Starts other programs in the repository's root.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Success, or an error message of one sentence.
pub type Outcome = Result<(), String>;

/// The repository's root.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the repository's root")
}

/// The environment variable that names a folder of models beside those of the repository, for tests and
/// benchmarks.
const MODELS: &str = "DARBOUX_MODELS";

/// The folder that [`MODELS`] names; without the variable `../shared/assets`, if it exists.
pub fn further_models() -> Option<PathBuf> {
    let beside = || Some(root().join("../shared/assets")).filter(|folder| folder.is_dir());
    std::env::var_os(MODELS).map(|folder| root().join(folder)).or_else(beside)
}

/// A command that starts a program in the root. `line` holds its name and arguments, separated by spaces.
pub fn program(line: &str) -> Command {
    let mut words = line.split_whitespace();
    let mut command = Command::new(words.next().expect("a program's name"));
    command.args(words).current_dir(root()).stdin(Stdio::null());
    command.envs(further_models().map(|folder| (MODELS, folder)));
    command
}

/// Runs a program to its end. Errors: it cannot start, or it fails.
pub fn run(command: &mut Command) -> Outcome {
    let status = command.status().map_err(|error| format!("{} cannot start: {error}", shown(command)))?;
    if status.success() { Ok(()) } else { Err(format!("{} failed ({status})", shown(command))) }
}

/// Runs a program to its end and returns its standard output. Errors: those of [`run`].
pub fn output_of(command: &mut Command) -> Result<Vec<u8>, String> {
    let output = command
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("{} cannot start: {error}", shown(command)))?;
    if output.status.success() {
        Ok(output.stdout)
    } else {
        Err(format!("{} failed ({})", shown(command), output.status))
    }
}

/// Redirects a program's standard output to standard error.
pub fn to_stderr(command: &mut Command) -> &mut Command {
    command.stdout(std::io::stderr())
}

/// True if the program starts and succeeds. Its output is discarded.
pub fn works(command: &mut Command) -> bool {
    command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// The command line as text.
pub fn shown(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

/// Cargo's target folder.
pub fn target_folder() -> Result<PathBuf, String> {
    let text = output_of(&mut program("cargo metadata --format-version 1 --no-deps"))?;
    let metadata: serde_json::Value =
        serde_json::from_slice(&text).map_err(|error| format!("cargo metadata: {error}"))?;
    let folder = metadata["target_directory"].as_str();
    folder.map(PathBuf::from).ok_or_else(|| "cargo metadata names no target_directory".into())
}

/// The files at or below a path, sorted; empty if the path does not exist.
pub fn files_below(path: &Path) -> Result<Vec<PathBuf>, String> {
    let mut files = Vec::new();
    let mut waiting = vec![path.to_path_buf()];
    while let Some(path) = waiting.pop() {
        let cannot_read = |error| format!("{} cannot be read: {error}", path.display());
        if path.is_dir() {
            for entry in std::fs::read_dir(&path).map_err(cannot_read)? {
                waiting.push(entry.map_err(cannot_read)?.path());
            }
        } else if path.exists() {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

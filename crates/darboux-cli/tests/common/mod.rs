//! Running the command on the repository's models and on broken ones.

#![allow(dead_code, reason = "each test file uses its part")]

pub mod builder;
#[cfg(target_os = "linux")]
pub mod limited;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

/// What a run of the command left.
pub struct Run {
    pub code: i32,
    pub stdout: Vec<u8>,
    pub stderr: String,
}

impl Run {
    /// Standard output as JSON.
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.stdout).expect("the report is JSON")
    }

    /// Expects the exit code; shows what was said if it is another.
    #[track_caller]
    pub fn exits(self, code: i32) -> Self {
        assert_eq!(self.code, code, "stderr: {}", self.stderr);
        self
    }
}

/// Runs `darboux` with these arguments and nothing on standard input.
pub fn darboux<A: AsRef<std::ffi::OsStr>>(arguments: &[A]) -> Run {
    darboux_reading(arguments, b"")
}

/// As [`darboux`], with 256 MiB of addresses where the system can limit them: a large allocation ends the
/// command.
pub fn darboux_with_little_memory<A: AsRef<std::ffi::OsStr>>(arguments: &[A]) -> Run {
    darboux_with_addresses(256 << 20, arguments)
}

/// As [`darboux_with_little_memory`], with this many bytes of addresses.
pub fn darboux_with_addresses<A: AsRef<std::ffi::OsStr>>(bytes: usize, arguments: &[A]) -> Run {
    if cfg!(target_os = "linux") {
        darboux_in_with_addresses(Path::new("."), bytes, arguments)
    } else {
        darboux(arguments)
    }
}

/// As [`darboux_with_addresses`], in a folder.
pub fn darboux_in_with_addresses<A: AsRef<std::ffi::OsStr>>(
    folder: &Path,
    bytes: usize,
    arguments: &[A],
) -> Run {
    let mut command = Command::new("sh");
    let line = format!("ulimit -v {} && exec \"$0\" \"$@\"", bytes >> 10);
    command.args(["-c", &line, env!("CARGO_BIN_EXE_darboux")]);
    command.current_dir(folder);
    run(command, arguments, b"")
}

/// As [`darboux`], where the system can be told to have no adapter.
pub fn darboux_without_adapters<A: AsRef<std::ffi::OsStr>>(arguments: &[A]) -> Run {
    darboux_with(&[("VK_DRIVER_FILES", "/nowhere"), ("VK_ICD_FILENAMES", "/nowhere")], arguments)
}

/// Runs `darboux` with variables of the environment.
pub fn darboux_with<A: AsRef<std::ffi::OsStr>>(variables: &[(&str, &str)], arguments: &[A]) -> Run {
    let mut command = program();
    command.envs(variables.iter().copied());
    run(command, arguments, b"")
}

/// Runs `darboux` with `stdin` on standard input.
pub fn darboux_reading<A: AsRef<std::ffi::OsStr>>(arguments: &[A], stdin: &[u8]) -> Run {
    run(program(), arguments, stdin)
}

/// The command as it was built with this test, or where both were moved to.
pub fn program() -> Command {
    let moved = std::env::var_os("DARBOUX_PROGRAM");
    Command::new(moved.unwrap_or_else(|| env!("CARGO_BIN_EXE_darboux").into()))
}

fn run<A: AsRef<std::ffi::OsStr>>(mut command: Command, arguments: &[A], stdin: &[u8]) -> Run {
    let mut child = command
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let mut pipe = child.stdin.take().expect("a pipe");
    std::thread::scope(|scope| {
        // A command that does not read its input closes the pipe, which is not an error.
        scope.spawn(move || pipe.write_all(stdin));
        let Output { status, stdout, stderr } = child.wait_with_output().expect("the command ends");
        let code = status.code().expect("the command ends by itself");
        Run { code, stdout, stderr: String::from_utf8(stderr).expect("messages are UTF-8") }
    })
}

/// A model of the repository.
pub fn asset(path: &str) -> PathBuf {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets").canonicalize().expect("assets");
    assets.join(path)
}

/// A fresh folder with copies of these models, without their folders.
pub fn folder_with(models: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for model in models {
        let name = Path::new(model).file_name().expect("a name");
        std::fs::copy(asset(model), folder.path().join(name)).expect("a copy");
    }
    folder
}

/// The path as an argument.
pub fn text(path: &Path) -> &str {
    path.to_str().expect("a UTF-8 path")
}

/// The names in a folder, sorted.
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// A GLB (glTF 2.0, 4.4).
pub fn glb(json: &Value, binary: &[u8]) -> Vec<u8> {
    let chunk = |kind: &[u8; 4], content: &[u8], padding: u8| {
        let length = content.len().next_multiple_of(4);
        let mut bytes = [&(length as u32).to_le_bytes()[..], kind, content].concat();
        bytes.resize(8 + length, padding);
        bytes
    };
    let chunks = [chunk(b"JSON", json.to_string().as_bytes(), b' '), chunk(b"BIN\0", binary, 0)].concat();
    [b"glTF", &2u32.to_le_bytes()[..], &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}

/// The JSON of a GLB.
pub fn glb_json(bytes: &[u8]) -> Value {
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).expect("the JSON chunk")
}

/// Whether `darboux devices` lists an adapter that can be used; says so once where there is none.
pub fn has_adapter() -> bool {
    let report = darboux(&["devices", "--json"]).exits(0).json();
    let adapters = report["adapters"].as_array().expect("a list");
    let usable = adapters.iter().any(|adapter| adapter["problem"].is_null());
    if !usable {
        assert!(std::env::var_os("CI").is_none(), "no adapter: {report}");
        writeln!(std::io::stdout(), "skipped: no adapter (Debian: mesa-vulkan-drivers, libvulkan1)")
            .expect("standard output");
    }
    usable
}

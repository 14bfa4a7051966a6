//! Helpers: builds the distribution folder, and compiles, links and runs C and C++ programs.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

use serde_json::Value;

/// The output folder of `cargo xtask dist-c`, built once per test run.
pub fn dist() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let output = run(Command::new(env!("CARGO")).args(["xtask", "dist-c"]).current_dir(repository()));
        let text = String::from_utf8(output.stdout).expect("text");
        PathBuf::from(text.lines().last().expect("a path"))
    })
}

pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The path of a file in this folder.
pub fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/c").join(name)
}

/// The folder of mikktspace.c, inside cargo's copy of the crate that contains it.
pub fn reference_sources() -> PathBuf {
    let output =
        run(Command::new(env!("CARGO")).args(["metadata", "--format-version=1"]).current_dir(repository()));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    let package =
        packages.iter().find(|package| package["name"] == "mikktspace-sys").expect("mikktspace-sys");
    Path::new(package["manifest_path"].as_str().expect("a path")).with_file_name("c_code")
}

/// True when a program is installed; otherwise prints that the test is skipped. Panics instead where `CI` is
/// set, so that CI skips nothing.
#[track_caller]
pub fn has(program: &str) -> bool {
    let found = Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    if found.is_err() {
        assert!(std::env::var_os("CI").is_none(), "there is no {program}, and CI is set");
        writeln!(std::io::stdout(), "skipped: there is no {program}").expect("standard output");
    }
    found.is_ok()
}

/// Runs a program and returns its output. Panics with the output where the program fails.
#[track_caller]
pub fn run(command: &mut Command) -> Output {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {}\n{errors}", output.status);
    output
}

/// As [`run`], with `input` on standard input.
#[track_caller]
pub fn run_with_input(command: &mut Command, input: &[u8]) -> Output {
    let file = folder().join(format!("input-{:?}", std::thread::current().id()));
    std::fs::write(&file, input).expect("a file");
    run(command.stdin(std::fs::File::open(&file).expect("the file")))
}

/// The folder of the compiled programs.
pub fn folder() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR"))
}

/// Static or shared linking.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Link {
    Shared,
    Static,
}

/// Compiles and links a program with all warnings as errors.
///
/// `standard`: such as "c99" or "c++17"; `files`: sources; `libraries`: "darboux", "darboux_mikktspace", or
/// none of ours.
#[track_caller]
pub fn build(name: &str, standard: &str, files: &[PathBuf], libraries: &[&str], link: Link) -> PathBuf {
    let program = folder().join(name);
    let mut command = compiler(standard);
    command.args(["-O2", "-I"]).arg(dist().join("include")).args(files).arg("-o").arg(&program);
    let folder = dist().join("lib");
    for library in libraries {
        if *library == "darboux_mikktspace" {
            command.arg("-I").arg(dist().join("include/mikktspace"));
        }
        match link {
            Link::Shared => command.arg("-L").arg(&folder).arg(format!("-l{library}")),
            Link::Static => command.arg(folder.join(format!("lib{library}.a"))),
        };
    }
    command.arg(format!("-Wl,-rpath,{}", folder.display()));
    run(command.args(["-lgcc_s", "-lpthread", "-lm", "-ldl"]));
    program
}

/// gcc or g++ with the strict flags of a standard.
pub fn compiler(standard: &str) -> Command {
    let mut command = Command::new(if standard.starts_with("c++") { "g++" } else { "gcc" });
    command.arg(format!("-std={standard}")).args(["-Wall", "-Wextra", "-pedantic", "-Werror"]);
    command
}

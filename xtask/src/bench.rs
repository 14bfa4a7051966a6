//! Builds and starts the benchmark.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::run::{Outcome, program, root, run, works};
use crate::{npm, python};

/// Makes glibc keep freed memory, so that no engine waits for fresh pages of the kernel, however it
/// allocates.
const ALLOCATOR: &str =
    "glibc.malloc.arena_max=1:glibc.malloc.mmap_max=0:glibc.malloc.trim_threshold=17179869184";

/// `cargo xtask bench`: `arguments` go to the benchmark, whose `--help` explains them.
pub fn bench(arguments: &[&str]) -> Outcome {
    let mut command = native();
    command.args(arguments);
    if let Some(folder) = node_packages()? {
        command.arg("--node").arg(folder);
    }
    run(&mut command)
}

/// The step of `ci`: no change takes more instructions than the committed counts say.
pub fn check_instructions() -> Outcome {
    if !cfg!(all(target_arch = "x86_64", target_os = "linux")) || !works(&mut program("valgrind --version")) {
        println!("skipped: instructions are counted on x86-64 Linux with valgrind");
        return Ok(());
    }
    run(native().args(["--baseline", "check"]))
}

/// The benchmark without the engines of npm.
fn native() -> Command {
    let mut command = program("cargo run --quiet --profile bench-room --package darboux-benches --");
    // As mikktspace.c is meant to be built: without its assertions.
    command.env("CFLAGS", "-DNDEBUG").env("GLIBC_TUNABLES", ALLOCATOR);
    command
}

/// `cargo xtask bench --gpu`: `arguments` go to the example that measures every adapter.
pub fn bench_gpu(arguments: &[&str]) -> Outcome {
    let line = "cargo run --quiet --profile bench-room --package darboux-gpu --example times --";
    run(program(line).args(arguments))
}

/// `cargo xtask bench --bake`: bakes with Blender's Cycles and with Darboux. `words`: texels per side,
/// threads, models.
pub fn bench_bake(words: &[&str]) -> Outcome {
    let [size, threads, models @ ..] = words else {
        return Err("bench --bake needs the texels per side, the threads and, if you like, models".into());
    };
    let line = "cargo run --quiet --release --package darboux-bake --all-features --example peers --";
    let mut command = program(line);
    command.arg(python::with_blender()?).arg("benches/bake/blender_bake.py");
    command.arg(root().join("target/bench-bake")).args([size, threads]).args(models);
    run(&mut command)
}

/// `cargo xtask maps`: prints how generated normal maps are judged. `options` go to the program.
pub fn judge_maps(options: &[&str]) -> Outcome {
    run(program("cargo run --quiet --release --package darboux-tests --bin maps --").args(options))
}

/// `cargo xtask maps --real`: prints how the normal maps below folders are judged.
pub fn judge_real_maps(folders: &[&str]) -> Outcome {
    let line = "cargo run --quiet --release --package darboux-check --example real_maps --";
    run(program(line).args(folders))
}

/// Installs the packages of benches/node at the versions of its lock file; none on a machine without node and
/// npm.
fn node_packages() -> Result<Option<PathBuf>, String> {
    if !works(&mut program("npm --version")) || !works(&mut program("node --version")) {
        println!("skipped: engines of npm; install Node.js 20 or newer to have them");
        return Ok(None);
    }
    let (from, to) = (root().join("benches/node"), root().join("target/bench-node"));
    let cannot_write = |error| format!("{} cannot be written: {error}", to.display());
    fs::create_dir_all(&to).map_err(cannot_write)?;
    for name in ["package.json", "package-lock.json", "peers.mjs"] {
        let text = fs::read(from.join(name)).map_err(cannot_write)?;
        if fs::read(to.join(name)).ok().as_ref() != Some(&text) {
            fs::write(to.join(name), text).map_err(cannot_write)?;
        }
    }
    npm::install("the benchmarks", &to)?;
    Ok(Some(to))
}

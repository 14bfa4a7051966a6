//! What must hold before a change lands.

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::python::WithoutPython;
use crate::run::{Outcome, program, root, run, shown, works};
use crate::validate::WithoutNpm;
use crate::{dist_js, dist_viewer, generated, layers, packages, python, validate};

type Step = (&'static str, fn() -> Outcome);

const QUICK: &[Step] = &[
    ("format", || run(&mut program("cargo fmt --all --check"))),
    ("clippy", || run(&mut program("cargo clippy --quiet --workspace --all-targets -- -D warnings"))),
    ("docs", || run(program("cargo doc --quiet --workspace --no-deps").env("RUSTDOCFLAGS", "-Dwarnings"))),
    ("layers", layers::check),
    ("generated files", generated::compare),
    ("models", || validate::all_models(without_npm())),
    ("packages", || packages::install(packages::FOR_TESTS)),
    ("tests", || test("cargo test --workspace")),
    ("python", || python::test(without_python())),
    ("npm package", || dist_js::test(without_npm())),
    ("viewer", || dist_viewer::test(without_npm())),
];

const LONG: &[Step] = &[
    ("acos", acos),
    ("small limits", small_limits),
    ("Arm", arm),
    ("long tests", || test("cargo test --release --workspace -- --ignored --skip acos_exhaustive")),
    ("Python wheel", python::test_wheel),
    ("Blender", python::blender),
    ("Ray, Dask, Open3D", python::large_packages),
    ("fuzzing", fuzz),
];

/// `cargo xtask ci`.
pub fn quick() -> Outcome {
    in_turn(QUICK)
}

/// `cargo xtask ci --full`.
pub fn full() -> Outcome {
    in_turn(LONG)?;
    in_turn(QUICK)
}

/// Our acos against the platform's on every float of [-1, 1].
pub fn acos() -> Outcome {
    run(&mut program("cargo test --release --package darboux -- --ignored acos_exhaustive --nocapture"))
}

/// The tests against the reference and on GPUs with tables, blocks and groups of two, so that every rare path runs.
fn small_limits() -> Outcome {
    let line =
        "cargo test --release --package darboux-tests --package darboux-gpu --target-dir target/small-limits";
    run(program(line).env("RUSTFLAGS", "--cfg small_limits"))
}

/// The bits of x86-64 on 64-bit Arm, emulated, and mikktspace.c's there. That one is compiled without fused operations, which GCC puts
/// into C on Arm unless told otherwise.
pub fn arm() -> Outcome {
    packages::install(packages::FOR_ARM)?;
    run(&mut program("rustup target add aarch64-unknown-linux-gnu"))?;
    let line = "cargo test --release --target aarch64-unknown-linux-gnu --package darboux-tests \
                --test platforms --test corpus --test differential --test plan --test oracle";
    let variables = [
        ("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER", "aarch64-linux-gnu-gcc"),
        ("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER", "qemu-aarch64 -L /usr/aarch64-linux-gnu"),
        ("CFLAGS_aarch64_unknown_linux_gnu", "-ffp-contract=off"),
    ];
    run(program(line).envs(variables))
}

/// Runs the steps in turn, up to the first that fails.
fn in_turn(steps: &[Step]) -> Outcome {
    for (name, step) in steps {
        println!("--- {name}");
        let start = Instant::now();
        step().map_err(|message| format!("{name}: {message}"))?;
        println!("--- {name}: ok, {:.1} s\n", start.elapsed().as_secs_f32());
    }
    Ok(())
}

/// CI must validate; a person without npm may go on without.
fn without_npm() -> WithoutNpm {
    if std::env::var_os("CI").is_some() { WithoutNpm::Fail } else { WithoutNpm::Skip }
}

/// As [`without_npm`], for Python.
fn without_python() -> WithoutPython {
    if std::env::var_os("CI").is_some() { WithoutPython::Fail } else { WithoutPython::Skip }
}

/// Runs `cargo test`, passes on what it prints, and adds up its counts.
fn test(line: &str) -> Outcome {
    let mut command = program(line);
    let mut child = command
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| format!("{} cannot start: {error}", shown(&command)))?;
    let mut counts = Counts::default();
    if let Some(output) = child.stdout.take() {
        counts.read(output);
    }
    let status = child.wait().map_err(|error| format!("{} cannot be awaited: {error}", shown(&command)))?;
    println!(
        "{} tests passed, {} failed, {} ignored, {} skipped",
        counts.passed, counts.failed, counts.ignored, counts.skipped
    );
    if status.success() { Ok(()) } else { Err(format!("{line} failed ({status})")) }
}

#[derive(Default)]
struct Counts {
    passed: usize,
    failed: usize,
    ignored: usize,
    skipped: usize,
}

impl Counts {
    fn read(&mut self, output: impl Read) {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            println!("{line}");
            self.skipped += usize::from(line.contains("skipped: "));
            if let Some(result) = line.strip_prefix("test result: ") {
                self.passed += number_before(result, " passed");
                self.failed += number_before(result, " failed");
                self.ignored += number_before(result, " ignored");
            }
        }
    }
}

/// The number that stands before `word` in `text`, 0 without one.
fn number_before(text: &str, word: &str) -> usize {
    let before = text.split(word).next().unwrap_or_default();
    before.rsplit(' ').next().and_then(|number| number.parse().ok()).unwrap_or(0)
}

/// One minute of each fuzz target.
fn fuzz() -> Outcome {
    if !works(&mut program("cargo +nightly fuzz --version")) {
        run(&mut program("rustup toolchain install nightly --profile minimal"))?;
        run(&mut program("cargo install cargo-fuzz --locked --version 0.13.1"))?;
    }
    let targets = std::fs::read_dir(root().join("fuzz/fuzz_targets"))
        .map_err(|error| format!("fuzz/fuzz_targets cannot be read: {error}"))?;
    let mut names: Vec<String> =
        targets.filter_map(|entry| Some(entry.ok()?.path().file_stem()?.to_str()?.to_owned())).collect();
    names.sort();
    names.iter().try_for_each(|name| run(&mut fuzz_target(name)))
}

fn fuzz_target(name: &str) -> Command {
    let mut command = program("cargo +nightly fuzz run");
    command.args([name, "--", "-max_total_time=60", "-rss_limit_mb=2048"]);
    // The C++ under the meshopt crate has two globals of one name in different files.
    command.env("ASAN_OPTIONS", "detect_odr_violation=0");
    command
}

//! `cargo xtask ci`: the checks that must pass before a change lands, each with its time.

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::python::WithoutPython;
use crate::run::{Outcome, program, root, run, shown, works};
use crate::validate::WithoutNpm;
use crate::{
    bench, comments, conformance, default_build, dist_js, dist_viewer, doc_blocks, generated, layers,
    packages, python, site, validate,
};

type Step = (&'static str, fn() -> Outcome);

const QUICK: &[Step] = &[
    ("format", || run(&mut program("cargo fmt --all --check"))),
    ("width of comments", comments::check),
    ("clippy", || run(&mut program("cargo clippy --quiet --workspace --all-targets -- -D warnings"))),
    // A workspace of its own, which the steps above do not see.
    ("fuzz targets compile", || {
        run(&mut program(
            "cargo check --quiet --manifest-path fuzz/Cargo.toml --target-dir target/fuzz-check",
        ))
    }),
    ("default build", default_build::check),
    ("docs", || run(program("cargo doc --quiet --workspace --no-deps").env("RUSTDOCFLAGS", "-Dwarnings"))),
    ("layers", layers::check),
    ("links", site::check),
    ("generated files", generated::compare),
    ("models", || validate::all_models(without_npm())),
    ("packages", || packages::install(packages::FOR_TESTS)),
    ("tests", || test("cargo test --workspace")),
    ("small limits", small_limits),
    ("instructions", bench::check_instructions),
    ("conformance suite", conformance::check),
    ("python", || python::test(without_python())),
    ("npm package", || dist_js::test(without_npm())),
    ("code blocks of the documentation", || doc_blocks::run(&[])),
    ("viewer", || dist_viewer::test(without_npm())),
    // A number of cases, and not a time, so that every machine runs the same.
    #[cfg(unix)]
    ("soak", || crate::soak::run(&["--cases", "1500", "--seed", "1"])),
];

const LONG: &[Step] = &[
    ("acos", acos),
    ("small limits, all tests", all_with_small_limits),
    ("mutations of the conformance suite", conformance::check_mutations),
    ("Arm", arm),
    ("long tests", || test("cargo test --release --workspace -- --ignored --skip acos_exhaustive")),
    ("Python wheel", python::test_wheel),
    ("Blender", python::blender),
    ("Ray, Dask, Open3D, USD", python::large_packages),
    ("Bevy's Mesh", || {
        run(&mut program(
            "cargo run --quiet --manifest-path examples/bevy/Cargo.toml --target-dir target/bevy",
        ))
    }),
    ("fuzzing", fuzz),
];

/// `cargo xtask ci`: the steps of every landing.
pub fn quick() -> Outcome {
    run_steps(QUICK)
}

/// `cargo xtask ci --full`: the long steps, then those of every landing.
pub fn full() -> Outcome {
    run_steps(LONG)?;
    run_steps(QUICK)
}

/// Compares the core's acos with the platform's on every float of [-1, 1].
pub fn acos() -> Outcome {
    run(&mut program("cargo test --release --package darboux -- --ignored acos_exhaustive --nocapture"))
}

/// Compiles hash tables, blocks and windows with a size of two, and starts threads for every mesh, so that
/// rare paths run in small tests.
const SMALL_LIMITS: [(&str, &str); 2] = [("RUSTFLAGS", "--cfg small_limits"), ("RAYON_NUM_THREADS", "3")];

/// The comparisons with mikktspace.c with [`SMALL_LIMITS`]. The folder of its own keeps the other builds'
/// cache valid.
fn small_limits() -> Outcome {
    let line = "cargo test --package darboux-tests --target-dir target/small-limits \
                --test differential --test corpus --test pathological --test plan --test callers_arrays";
    run(program(line).envs(SMALL_LIMITS))
}

/// All tests of the core and of the GPU with [`SMALL_LIMITS`].
fn all_with_small_limits() -> Outcome {
    let line =
        "cargo test --release --package darboux-tests --package darboux-gpu --target-dir target/small-limits";
    run(program(line).envs(SMALL_LIMITS))
}

/// The tests of bits, on emulated 64-bit Arm. mikktspace.c is compiled without fused operations, which GCC
/// uses on Arm by default.
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

/// Runs the steps in order and stops at the first that fails.
fn run_steps(steps: &[Step]) -> Outcome {
    for (name, step) in steps {
        println!("--- {name}");
        let start = Instant::now();
        step().map_err(|message| format!("{name}: {message}"))?;
        println!("--- {name}: ok, {:.1} s\n", start.elapsed().as_secs_f32());
    }
    Ok(())
}

/// In CI npm is required; elsewhere steps that need it are skipped.
fn without_npm() -> WithoutNpm {
    if std::env::var_os("CI").is_some() { WithoutNpm::Fail } else { WithoutNpm::Skip }
}

/// Like [`without_npm`], for Python.
fn without_python() -> WithoutPython {
    if std::env::var_os("CI").is_some() { WithoutPython::Fail } else { WithoutPython::Skip }
}

/// Runs `cargo test`, prints its output, and adds up the counts of all test programs.
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
    let status = child.wait().map_err(|error| format!("{} gave no exit status: {error}", shown(&command)))?;
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

/// The number before the first `word` in `text`; 0 if there is none.
fn number_before(text: &str, word: &str) -> usize {
    let before = text.split(word).next().unwrap_or_default();
    before.rsplit(' ').next().and_then(|number| number.parse().ok()).unwrap_or(0)
}

/// Runs each fuzz target for one minute.
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
    // The C++ code of the meshopt crate defines one global in two files.
    command.env("ASAN_OPTIONS", "detect_odr_violation=0");
    command
}

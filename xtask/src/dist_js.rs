//! The folder that is published as the npm package darboux.

use std::fs;
use std::path::{Path, PathBuf};

use crate::run::{Outcome, program, root, run, target_folder, to_stderr, works};
use crate::validate::WithoutNpm;

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// WebAssembly, with nothing around it.
pub const TRIPLE: &str = "wasm32-unknown-unknown";

/// Forms of a module, and what the compiler may use in them.
const FORMS: &[(&str, &str)] = &[("simd", "-Ctarget-feature=+simd128"), ("scalar", "")];

/// What is called from several places is copied to none, and loops of unknown length are not unrolled: an eighth smaller, and no slower.
/// Loops stay vector code, as they would not at optimisation levels for size.
const SMALLER: &str = "-Cllvm-args=-inline-threshold=0 -Cllvm-args=-inlinehint-threshold=30 \
    -Cllvm-args=-unroll-runtime=false -Cllvm-args=-unroll-allow-partial=false";

/// Modules, and their features of darboux-js.
const MODULES: &[(&str, &str)] = &[("darboux", "full"), ("tangents", "")];

/// Makes the folder and runs the tests of what is in it.
pub fn test(without: WithoutNpm) -> Outcome {
    if matches!(without, WithoutNpm::Skip) && !works(&mut program("npm --version")) {
        println!("skipped: the npm package needs node and npm");
        return Ok(());
    }
    make_folder()?;
    run(program("npm test").current_dir(root().join("bindings/js")))
}

/// `cargo xtask dist-js`: makes the folder, and prints its absolute path as the last line.
pub fn make() -> Outcome {
    println!("{}", make_folder()?.display());
    Ok(())
}

/// Where the folder is made.
pub fn folder() -> Result<PathBuf, String> {
    Ok(target_folder()?.join("dist-js/darboux"))
}

/// Makes the folder; gives its path.
pub fn make_folder() -> Result<PathBuf, String> {
    run(to_stderr(&mut program(&format!("rustup target add {TRIPLE}"))))?;
    let (target, folder) = (target_folder()?, folder()?);
    let modules = target.join("dist-js/modules");
    fs::create_dir_all(&modules).map_err(|error| format!("{} cannot be made: {error}", modules.display()))?;
    for (name, features) in MODULES {
        for (form, flags) in FORMS {
            compile(&target, features, flags, &modules.join(format!("{name}.{form}.wasm")))?;
        }
    }
    let ours = root().join("bindings/js");
    run(to_stderr(program("npm ci --no-audit --no-fund").current_dir(&ours)))?;
    run(to_stderr(program("node build.mjs").args([&modules, &folder]).arg(VERSION).current_dir(&ours)))?;
    Ok(folder)
}

fn compile(target: &Path, features: &str, flags: &str, out: &Path) -> Outcome {
    let mut cargo = program("cargo build --quiet --profile dist --package darboux-js --target");
    run(to_stderr(
        cargo
            .args([TRIPLE, "--no-default-features", "--features", features])
            // `build.mjs` finds functions by their names, and strips them then.
            .env("CARGO_PROFILE_DIST_STRIP", "none")
            .env("RUSTFLAGS", format!("{flags} {SMALLER}")),
    ))?;
    let built = target.join(TRIPLE).join("dist/darboux_js.wasm");
    fs::copy(&built, out)
        .map(|_| ())
        .map_err(|error| format!("{} cannot be copied: {error}", built.display()))
}

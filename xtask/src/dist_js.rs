//! The folder that is published as the npm package darboux.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use wasmparser::{KnownCustom, Name, Parser, Payload};

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

/// Modules, their features of darboux-js, and how they are compiled.
const MODULES: &[(&str, &str, Size)] = &[("darboux", "full", Size::AsItIs), ("tangents", "", Size::Small)];

/// How a module is compiled.
#[derive(Clone, Copy, PartialEq)]
enum Size {
    AsItIs,
    /// For size, but for the tasks that are compiled per vector width: what takes the time.
    Small,
}

/// An attribute of every function, taken from some of them again.
const FOR_SIZE: &str = "-Cllvm-args=-force-attribute=optsize";

/// What the names of the functions that run such tasks hold (see `tangents/width.rs` of the core), however the compiler mangles them.
const TASK: &str = "5Width3run";

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
    for (name, features, size) in MODULES {
        for (form, flags) in FORMS {
            eprintln!("compiling {name} ({form}), a minute or more");
            let out = modules.join(format!("{name}.{form}.wasm"));
            compile(&target, features, flags, &out)?;
            if *size == Size::Small {
                let tasks = tasks_of(&out)?;
                compile(&target, features, &format!("{flags} {FOR_SIZE}{}", but_for(&tasks)), &out)?;
                if tasks_of(&out)? != tasks {
                    return Err(format!(
                        "{}: its tasks have new names, so that they are slow",
                        out.display()
                    ));
                }
            }
        }
    }
    let ours = root().join("bindings/js");
    eprintln!("making the modules smaller, and bundling");
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

/// The names of the tasks that a compiled module has. Errors: there are none.
fn tasks_of(module: &Path) -> Result<BTreeSet<String>, String> {
    let read = fs::read(module).map_err(|error| format!("{} cannot be read: {error}", module.display()))?;
    let names = names(&read).map_err(|error| format!("{} has no names: {error}", module.display()))?;
    let tasks: BTreeSet<String> =
        names.into_iter().filter(|name| name.contains(TASK)).map(str::to_owned).collect();
    if tasks.is_empty() {
        return Err(format!("no function of {} is called as tasks are ({TASK})", module.display()));
    }
    Ok(tasks)
}

/// Flags that take [`FOR_SIZE`] from tasks.
fn but_for(tasks: &BTreeSet<String>) -> String {
    tasks.iter().map(|name| format!(" -Cllvm-args=-force-remove-attribute={name}:optsize")).collect()
}

/// The functions of a module, as the compiler names them.
fn names(module: &[u8]) -> wasmparser::Result<Vec<&str>> {
    let mut names = Vec::new();
    for payload in Parser::new(0).parse_all(module) {
        let Payload::CustomSection(section) = payload? else { continue };
        let KnownCustom::Name(parts) = section.as_known() else { continue };
        for part in parts {
            if let Name::Function(functions) = part? {
                for function in functions {
                    names.push(function?.name);
                }
            }
        }
    }
    Ok(names)
}

//! `cargo xtask dist-viewer [--release]`: the viewer's page as static files, which `darboux view` serves.
//!
//! ```text
//! at the same time:  make the npm package, with the entries that the page imports
//!                    compile the page's own WebAssembly modules (reading and writing models)
//!                    install the npm packages of the page
//! then (build.mjs):  shrink the modules (only for a release), check types, bundle the page
//! ```
//!
//! A release has two modules of its own: pages load the larger one for other formats than glTF. A quick build
//! has one, which reads FBX where clang is there.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

use crate::dist_js::{self, BAKE, Build, CHECK, FULL, TRIPLE};
use crate::npm;
use crate::progress::step;
use crate::run::{Outcome, program, root, run, target_folder, to_stderr, works};
use crate::validate::WithoutNpm;
use crate::wasm_c::Clang;

/// The browser of the tests, unless the environment variable CHROMIUM names another.
const CHROMIUM: &str = "/usr/bin/chromium";

/// The crate of the page's module.
const PACKAGE: &str = "darboux-viewer";

/// Makes the page and prints its absolute folder as the last line.
pub fn make(build: Build) -> Outcome {
    println!("{}", make_page(build)?.display());
    Ok(())
}

/// Makes the page and returns its absolute folder.
pub fn make_page(build: Build) -> Result<PathBuf, String> {
    eprintln!("the viewer's page: WebAssembly modules, bundled with TypeScript and three.js");
    let package = package()?;
    let modules = thread::scope(|scope| {
        let modules = scope.spawn(|| prepare(build));
        dist_js::make_folder(&package, &[FULL, CHECK, BAKE], build)?;
        modules.join().expect("compiling does not panic")
    })?;
    bundle(&package, &modules, build)
}

/// The folder of the npm package with the entries that the page imports.
pub fn package() -> Result<PathBuf, String> {
    Ok(target_folder()?.join("dist-viewer/darboux"))
}

/// Makes the page as it is released, with the npm package that [`dist_js::test`] has made, and tests it in a
/// browser with the command's server and outputs.
pub fn test(without: WithoutNpm) -> Outcome {
    let can_skip = matches!(without, WithoutNpm::Skip);
    if can_skip && (!works(&mut program("npm --version")) || Clang::find().is_err()) {
        println!("skipped: the viewer needs node, npm and clang");
        return Ok(());
    }
    let modules = prepare(Build::Release)?;
    bundle(&dist_js::folder()?, &modules, Build::Release)?;
    let browser = std::env::var_os("CHROMIUM").unwrap_or_else(|| CHROMIUM.into());
    if can_skip && !Path::new(&browser).exists() {
        println!(
            "skipped: the viewer's tests need Chromium at {CHROMIUM}, or its path in the environment \
             variable CHROMIUM"
        );
        return Ok(());
    }
    run(&mut program("cargo build --quiet --package darboux-cli --features full"))?;
    let command = target_folder()?.join("debug/darboux");
    run(program("npm test --silent").current_dir(viewer()).env("CHROMIUM", browser).env("DARBOUX", command))
}

fn viewer() -> PathBuf {
    root().join("viewer")
}

/// Installs the npm packages and compiles the modules of the page. Returns their paths: the smaller one
/// first, where there are two.
fn prepare(build: Build) -> Result<Vec<PathBuf>, String> {
    npm::install("viewer", &viewer())?;
    match build {
        Build::Quick => step("compile the module of the page", || {
            // The features that the npm package's modules have, so that darboux-io is compiled once for all.
            let clang = Clang::find_or_say();
            let features = if clang.is_some() { "larger" } else { "darboux-io/default" };
            let folder = dist_js::compile_quickly(PACKAGE, &["--features", features], clang.as_ref())?;
            Ok(vec![folder.join("darboux_viewer.wasm")])
        }),
        Build::Release => {
            let clang = Clang::find()?;
            let smaller =
                step("compile the module of the page", || compile_for_release("darboux_viewer", None))?;
            let larger = step("compile the module of the page that reads all formats", || {
                compile_for_release("darboux_viewer_larger", Some(&clang))
            })?;
            Ok(vec![smaller, larger])
        }
    }
}

/// Compiles a module in a target folder of its own, at the same time as those of the npm package: the larger
/// one with a compiler for the reader of FBX. Returns the path of the module.
fn compile_for_release(name: &str, clang: Option<&Clang>) -> Result<PathBuf, String> {
    let target = target_folder()?.join("dist-viewer/module");
    let mut cargo = program("cargo build --quiet --profile page --package");
    cargo.args([PACKAGE, "--target", TRIPLE]).env("CARGO_TARGET_DIR", &target);
    if let Some(clang) = clang {
        cargo.args(["--features", "larger"]);
        clang.compile_ufbx(&mut cargo);
    }
    run(to_stderr(&mut cargo))?;
    let (built, kept) =
        (target.join(TRIPLE).join("page/darboux_viewer.wasm"), target.join(name).with_extension("wasm"));
    fs::copy(&built, &kept)
        .map_err(|error| format!("{} cannot be copied to {}: {error}", built.display(), kept.display()))?;
    Ok(kept)
}

/// Bundles the page with the npm package in a folder and the page's modules. Returns the page's own folder.
fn bundle(package: &Path, modules: &[PathBuf], build: Build) -> Result<PathBuf, String> {
    step("check types and bundle the page", || {
        let mut node = program("node build.mjs");
        run(to_stderr(node.arg(package).arg(build.name()).args(modules).current_dir(viewer())))
    })?;
    Ok(viewer().join("dist"))
}

//! `cargo xtask dist-viewer [--release]`: the viewer's page as static files, which `darboux view` serves.
//!
//! ```text
//! at the same time:  make the npm package, with the entries that the page imports
//!                    compile the page's own WebAssembly module (reading and writing glTF)
//!                    install the npm packages of the page
//! then (build.mjs):  shrink the module (only for a release), check types, bundle the page
//! ```

use std::path::{Path, PathBuf};
use std::thread;

use crate::dist_js::{self, BAKE, Build, CHECK, FULL, TRIPLE};
use crate::npm;
use crate::progress::step;
use crate::run::{Outcome, program, root, run, target_folder, to_stderr, works};
use crate::validate::WithoutNpm;

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
    let module = thread::scope(|scope| {
        let module = scope.spawn(|| prepare(build));
        dist_js::make_folder(&package, &[FULL, CHECK, BAKE], build)?;
        module.join().expect("compiling does not panic")
    })?;
    bundle(&package, &module, build)
}

/// The folder of the npm package with the entries that the page imports.
pub fn package() -> Result<PathBuf, String> {
    Ok(target_folder()?.join("dist-viewer/darboux"))
}

/// Makes the page with the npm package that [`dist_js::test`] has made, and tests it in a browser with the
/// command's server and outputs.
pub fn test(without: WithoutNpm) -> Outcome {
    let can_skip = matches!(without, WithoutNpm::Skip);
    if can_skip && !works(&mut program("npm --version")) {
        println!("skipped: the viewer needs node and npm");
        return Ok(());
    }
    let module = prepare(Build::Release)?;
    bundle(&dist_js::folder()?, &module, Build::Release)?;
    let browser = std::env::var_os("CHROMIUM").unwrap_or_else(|| CHROMIUM.into());
    if can_skip && !Path::new(&browser).exists() {
        println!(
            "skipped: the viewer's tests need Chromium at {CHROMIUM}, or its path in the environment variable CHROMIUM"
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

/// Installs the npm packages and compiles the module of the page. Returns the path of the module.
fn prepare(build: Build) -> Result<PathBuf, String> {
    npm::install("viewer", &viewer())?;
    let folder = step("compile the module of the page", || match build {
        // The feature that the npm package's modules need, so that darboux-io is compiled once for all.
        Build::Quick => dist_js::compile_quickly(PACKAGE, &["--features", "darboux-io/textures"]),
        Build::Release => compile_for_release(),
    })?;
    Ok(folder.join("darboux_viewer.wasm"))
}

/// Compiles the module in a target folder of its own, at the same time as those of the npm package. Returns
/// the folder of the module.
fn compile_for_release() -> Result<PathBuf, String> {
    let target = target_folder()?.join("dist-viewer/module");
    let mut cargo = program("cargo build --quiet --profile page --package");
    run(to_stderr(cargo.args([PACKAGE, "--target", TRIPLE]).env("CARGO_TARGET_DIR", &target)))?;
    Ok(target.join(TRIPLE).join("page"))
}

/// Bundles the page with the npm package in a folder and the page's module. Returns the page's own folder.
fn bundle(package: &Path, module: &Path, build: Build) -> Result<PathBuf, String> {
    step("check types and bundle the page", || {
        let mut node = program("node build.mjs");
        run(to_stderr(node.args([package, module]).arg(build.name()).current_dir(viewer())))
    })?;
    Ok(viewer().join("dist"))
}

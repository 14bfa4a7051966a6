//! `cargo xtask dist-viewer`: the viewer's page as static files, which `darboux view` serves.
//!
//! ```text
//! at the same time:  make the npm package, with the entries that the page imports
//!                    compile the page's own WebAssembly module (reading and writing glTF)
//!                    install the npm packages of the page
//! then (build.mjs):  shrink the module, check types, bundle the page
//! ```

use std::path::{Path, PathBuf};
use std::thread;

use crate::dist_js::{self, BAKE, CHECK, FULL, TRIPLE};
use crate::npm;
use crate::progress::step;
use crate::run::{Outcome, program, root, run, target_folder, to_stderr, works};
use crate::validate::WithoutNpm;

/// The browser of the tests, unless the environment variable CHROMIUM names another.
const CHROMIUM: &str = "/usr/bin/chromium";

/// `cargo xtask dist-viewer`: makes the page and prints its absolute folder as the last line.
pub fn make() -> Outcome {
    println!("{}", make_page()?.display());
    Ok(())
}

/// Makes the page and returns its absolute folder.
pub fn make_page() -> Result<PathBuf, String> {
    eprintln!("the viewer's page: 7 WebAssembly modules, bundled with TypeScript and three.js");
    let package = package()?;
    thread::scope(|scope| {
        let page = scope.spawn(prepare);
        dist_js::make_folder(&package, &[FULL, CHECK, BAKE])?;
        page.join().expect("compiling does not panic")
    })?;
    bundle(&package)
}

/// The folder of the npm package with the entries that the page imports.
pub fn package() -> Result<PathBuf, String> {
    Ok(target_folder()?.join("dist-viewer/darboux"))
}

/// Makes the page with the npm package that [`dist_js::test`] has made, and tests it in a browser with the command's server and outputs.
pub fn test(without: WithoutNpm) -> Outcome {
    let can_skip = matches!(without, WithoutNpm::Skip);
    if can_skip && !works(&mut program("npm --version")) {
        println!("skipped: the viewer needs node and npm");
        return Ok(());
    }
    prepare()?;
    bundle(&dist_js::folder()?)?;
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

/// The target folder of the page's module: its own, so that it is compiled at the same time as the npm package.
fn target() -> Result<PathBuf, String> {
    Ok(target_folder()?.join("dist-viewer/module"))
}

/// Installs the npm packages and compiles the module of the page.
fn prepare() -> Outcome {
    npm::install("viewer", &viewer())?;
    let target = target()?;
    step("compile the module of the page", || {
        let mut cargo = program("cargo build --quiet --profile page --package darboux-viewer --target");
        run(to_stderr(cargo.arg(TRIPLE).env("CARGO_TARGET_DIR", target)))
    })
}

/// Bundles the page with the npm package in a folder. Returns the page's own folder.
fn bundle(package: &Path) -> Result<PathBuf, String> {
    let module = target()?.join(TRIPLE).join("page/darboux_viewer.wasm");
    step("shrink the module, check types, and bundle the page", || {
        run(to_stderr(program("node build.mjs").args([package, &module]).current_dir(viewer())))
    })?;
    Ok(viewer().join("dist"))
}

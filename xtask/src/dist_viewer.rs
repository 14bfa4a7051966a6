//! The viewer's page, as static files.

use std::path::{Path, PathBuf};

use crate::dist_js::{self, TRIPLE};
use crate::run::{Outcome, program, root, run, target_folder, to_stderr, works};
use crate::validate::WithoutNpm;

/// The browser that tests run in, where CHROMIUM names no other.
const CHROMIUM: &str = "/usr/bin/chromium";

/// `cargo xtask dist-viewer`: makes the page, and prints its absolute folder as the last line.
pub fn make() -> Outcome {
    println!("{}", make_with(&dist_js::make_folder()?)?.display());
    Ok(())
}

/// Makes the page of the npm package that [`dist_js::test`] has made, and tests it in a browser with the command's server and outputs.
pub fn test(without: WithoutNpm) -> Outcome {
    let can_skip = matches!(without, WithoutNpm::Skip);
    if can_skip && !works(&mut program("npm --version")) {
        println!("skipped: the viewer needs node and npm");
        return Ok(());
    }
    make_with(&dist_js::folder()?)?;
    let browser = std::env::var_os("CHROMIUM").unwrap_or_else(|| CHROMIUM.into());
    if can_skip && !Path::new(&browser).exists() {
        println!("skipped: the viewer's tests need Chromium, at {CHROMIUM} or where CHROMIUM says");
        return Ok(());
    }
    run(&mut program("cargo build --quiet --package darboux-cli"))?;
    let command = target_folder()?.join("debug/darboux");
    run(program("npm test --silent").current_dir(viewer()).env("CHROMIUM", browser).env("DARBOUX", command))
}

fn viewer() -> PathBuf {
    root().join("viewer")
}

/// Makes the page with the npm package in a folder; gives the page's own.
fn make_with(package: &Path) -> Result<PathBuf, String> {
    let mut cargo = program("cargo build --quiet --profile page --package darboux-viewer --target");
    run(to_stderr(cargo.arg(TRIPLE)))?;
    let module = target_folder()?.join(TRIPLE).join("page/darboux_viewer.wasm");
    run(to_stderr(program("npm ci --no-audit --no-fund").current_dir(viewer())))?;
    run(to_stderr(program("node build.mjs").args([package, &module]).current_dir(viewer())))?;
    Ok(viewer().join("dist"))
}

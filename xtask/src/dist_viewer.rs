//! The viewer's page, as static files.

use std::path::PathBuf;

use crate::dist_js::{self, TRIPLE};
use crate::run::{Outcome, program, root, run, target_folder, to_stderr};

/// `cargo xtask dist-viewer`: makes the page, and prints its absolute folder as the last line.
pub fn make() -> Outcome {
    println!("{}", make_folder()?.display());
    Ok(())
}

/// Makes the page; gives its folder.
fn make_folder() -> Result<PathBuf, String> {
    let package = dist_js::make_folder()?;
    let mut cargo = program("cargo build --quiet --profile dist --package darboux-viewer --target");
    run(to_stderr(cargo.arg(TRIPLE)))?;
    let module = target_folder()?.join(TRIPLE).join("dist/darboux_viewer.wasm");
    let viewer = root().join("viewer");
    run(to_stderr(program("npm ci --no-audit --no-fund").current_dir(&viewer)))?;
    run(to_stderr(program("node build.mjs").args([package, module]).current_dir(&viewer)))?;
    Ok(viewer.join("dist"))
}

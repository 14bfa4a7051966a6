//! The viewer's page, as static files.

use crate::dist_js;
use crate::run::{Outcome, program, root, run, to_stderr};

/// `cargo xtask dist-viewer`: makes the page, and prints its absolute folder as the last line.
pub fn make() -> Outcome {
    let package = dist_js::make_folder()?;
    let viewer = root().join("viewer");
    run(to_stderr(program("npm ci --no-audit --no-fund").current_dir(&viewer)))?;
    run(to_stderr(program("node build.mjs").arg(package).current_dir(&viewer)))?;
    println!("{}", viewer.join("dist").display());
    Ok(())
}

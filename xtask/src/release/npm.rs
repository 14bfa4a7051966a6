//! The npm archive: packed, installed into an empty folder, and used by the README's first example.

use std::fs;

use super::work::{VERSION, empty_folder, print_size};
use crate::run::{Outcome, program, run};
use crate::{dist_js, doc_blocks};

/// Makes the npm package, packs and installs it, and runs the example.
pub fn check() -> Outcome {
    dist_js::make(dist_js::Build::Release)?;
    let made = dist_js::folder()?;
    let work = empty_folder("npm")?;
    run(program("npm pack --silent --pack-destination").arg(&work).current_dir(&made))?;
    let archive = work.join(format!("darboux-{VERSION}.tgz"));
    print_size(&archive);
    run(program("npm install --silent --no-audit --no-fund --prefix .").arg(&archive).current_dir(&work))?;
    let example = work.join("example.mjs");
    fs::write(&example, doc_blocks::first("bindings/js/README.md", "js")?)
        .map_err(|error| format!("{} cannot be written: {error}", example.display()))?;
    run(program("node example.mjs").current_dir(&work))
}

//! npm packages that a folder with a `package-lock.json` needs.

use std::fs;
use std::path::Path;

use crate::progress::step;
use crate::run::{Outcome, program, run, to_stderr};

/// A copy of the lock file that the installed packages were made from.
const INSTALLED: &str = "node_modules/.installed-lock.json";

/// Installs the packages of a folder, unless those of its lock file are installed already. `what` names the
/// folder in progress lines.
pub fn install(what: &str, folder: &Path) -> Outcome {
    let (lock, installed) = (folder.join("package-lock.json"), folder.join(INSTALLED));
    let wanted = fs::read(&lock).map_err(|error| format!("{} cannot be read: {error}", lock.display()))?;
    if fs::read(&installed).is_ok_and(|found| found == wanted) {
        return Ok(());
    }
    step(&format!("install the npm packages of {what}"), || {
        run(to_stderr(program("npm ci --no-audit --no-fund --loglevel=error").current_dir(folder)))
    })?;
    fs::write(&installed, wanted)
        .map_err(|error| format!("{} cannot be written: {error}", installed.display()))
}

//! What all steps of a release share: versions, and folders to install into.

use std::fs;
use std::path::{Path, PathBuf};

use crate::run::target_folder;

/// The version of all packages.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The oldest supported compiler.
pub const RUST_VERSION: &str = env!("CARGO_PKG_RUST_VERSION");

/// An empty folder below cargo's target folder.
pub fn empty_folder(name: &str) -> Result<PathBuf, String> {
    let folder = target_folder()?.join("release").join(name);
    if folder.exists() {
        fs::remove_dir_all(&folder)
            .map_err(|error| format!("{} cannot be removed: {error}", folder.display()))?;
    }
    fs::create_dir_all(&folder).map_err(|error| format!("{} cannot be made: {error}", folder.display()))?;
    Ok(folder)
}

/// Prints the path and size of a finished package.
pub fn print_size(package: &Path) {
    let bytes = fs::metadata(package).map_or(0, |file| file.len());
    println!("{} ({} kB)", package.display(), bytes / 1000);
}

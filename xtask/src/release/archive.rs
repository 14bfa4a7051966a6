//! `cargo xtask release`: an archive with the command and the viewer for the machine that this runs on, for
//! people without compilers.

use std::env::consts::{ARCH, EXE_SUFFIX, OS};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::work::{VERSION, empty_folder, print_size};
use crate::dist_js::Build;
use crate::dist_viewer;
use crate::progress::step;
use crate::run::{Outcome, files_below, program, root, run, target_folder, to_stderr};

/// Files that are copied unchanged: their paths in the repository and in the archive.
const FILES: &[(&str, &str)] = &[
    ("LICENSE-APACHE", "LICENSE-APACHE"),
    ("LICENSE-MIT", "LICENSE-MIT"),
    ("ATTRIBUTION.md", "ATTRIBUTION.md"),
    ("assets/made/shield.glb", "shield.glb"),
];

/// Folders that are copied with all their files.
const FOLDERS: &[(&str, &str)] = &[
    ("crates/darboux-cli/generated/man", "man"),
    ("crates/darboux-cli/generated/completions", "completions"),
];

/// Makes the archive, unpacks it into an empty folder, runs the command from there, and prints the archive's
/// path as the last line.
pub fn make() -> Outcome {
    let name = format!("darboux-{VERSION}-{OS}-{ARCH}");
    let work = empty_folder("archive")?;
    fill(&work.join(&name))?;
    // Windows has tar, too, which makes archives that its file manager opens.
    let archive = work.join(format!("{name}.tar.gz"));
    run(Command::new("tar").arg("czf").arg(&archive).arg("-C").arg(&work).arg(&name))?;
    try_out(&archive, &name)?;
    print_size(&archive);
    println!("{}", archive.display());
    Ok(())
}

/// Builds the command with all features and the viewer's page, and puts both into a folder as `darboux view`
/// expects them.
fn fill(folder: &Path) -> Outcome {
    let page = dist_viewer::make_page(Build::Release)?;
    step("compile the command with all features", || {
        run(to_stderr(&mut program(
            "cargo build --quiet --release --locked --package darboux-cli --features full",
        )))
    })?;
    let command = format!("darboux{EXE_SUFFIX}");
    copy(&target_folder()?.join("release").join(&command), &folder.join(&command))?;
    copy_folder(&page, &folder.join("viewer"))?;
    FOLDERS.iter().try_for_each(|(from, to)| copy_folder(&root().join(from), &folder.join(to)))?;
    FILES.iter().try_for_each(|(from, to)| copy(&root().join(from), &folder.join(to)))
}

/// Unpacks the archive and repairs its sample with the command in it.
fn try_out(archive: &Path, name: &str) -> Outcome {
    let elsewhere = empty_folder("archive-unpacked")?;
    run(Command::new("tar").arg("xzf").arg(archive).arg("-C").arg(&elsewhere))?;
    let folder = elsewhere.join(name);
    if !folder.join("viewer/index.html").is_file() {
        return Err(format!("{} lacks the viewer's page", archive.display()));
    }
    let command = || Command::new(folder.join(format!("darboux{EXE_SUFFIX}")));
    let repaired = elsewhere.join("repaired.glb");
    run(command().args(["check", "--quiet", "--fix", "-o"]).arg(&repaired).arg(folder.join("shield.glb")))?;
    run(command().args(["check", "--quiet"]).arg(&repaired))
}

fn copy_folder(from: &Path, to: &Path) -> Outcome {
    files_below(from)?.iter().try_for_each(|file| {
        let inside: PathBuf = file.strip_prefix(from).unwrap_or(file).into();
        copy(file, &to.join(inside))
    })
}

fn copy(from: &Path, to: &Path) -> Outcome {
    let folder = to.parent().unwrap_or(to);
    fs::create_dir_all(folder).map_err(|error| format!("{} cannot be made: {error}", folder.display()))?;
    fs::copy(from, to).map(|_| ()).map_err(|error| format!("{} cannot be copied: {error}", from.display()))
}

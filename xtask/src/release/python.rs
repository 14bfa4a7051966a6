//! The source archive and the wheel: each installed into an empty environment, where the example runs.

use std::path::{Path, PathBuf};

use super::work::{empty_folder, print_size};
use crate::python;
use crate::run::{Outcome, files_below, run};

/// Makes both archives, and runs `examples/tangents.py` with each.
pub fn check() -> Outcome {
    let work = empty_folder("python")?;
    let wheel = one_file(&python::make_wheel()?, "whl")?;
    print_size(&wheel);
    run_example(&wheel, &work.join("wheel"))?;
    let archives = work.join("archives");
    python::make_source_archive(&archives)?;
    let source = one_file(&archives, "gz")?;
    print_size(&source);
    run_example(&source, &work.join("source"))
}

/// Installs an archive into a new environment and runs the example there.
fn run_example(archive: &Path, environment: &Path) -> Outcome {
    let interpreter = python::fresh_environment("python3", environment)?;
    run(python::pip(&interpreter).arg(archive))?;
    run(&mut python::with(&interpreter, "bindings/python/examples/tangents.py"))
}

/// The only file with an extension below a folder.
fn one_file(folder: &Path, extension: &str) -> Result<PathBuf, String> {
    let mut files = files_below(folder)?;
    files.retain(|file| file.extension().is_some_and(|found| found == extension));
    match &files[..] {
        [file] => Ok(file.clone()),
        others => Err(format!("{} files *.{extension} in {}, not one", others.len(), folder.display())),
    }
}

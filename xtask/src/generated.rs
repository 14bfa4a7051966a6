//! Files that are generated and committed: written by `cargo xtask gen`, compared by `cargo xtask ci`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::api;
use crate::functions;
use crate::run::{Outcome, files_below, program, root, run};
use crate::shaders;

/// The files and folders that are generated. Such a folder holds nothing else.
const GENERATED_PATHS: &[&str] = &[
    "docs/cli.md",
    "docs/check.md",
    "crates/darboux-cli/generated",
    "bindings/c/include/darboux.h",
    "bindings/js/lib/core/choices.ts",
    "bindings/python/python/darboux/_choices.py",
    "viewer/src/surface/methods.ts",
    "shaders/glsl",
    "shaders/hlsl",
    shaders::RENDER_COPIES,
    "docs/api",
    functions::PAGE,
];

/// Packages and the examples in them that write generated files below a given folder.
const WRITERS: &[(&str, &str)] =
    &[("darboux-cli", "choices"), ("darboux-cli", "pages"), ("darboux-c", "header")];

/// Writes all generated files into the repository.
pub fn write() -> Outcome {
    for place in GENERATED_PATHS {
        remove(&root().join(place))?;
    }
    generate(root())
}

/// Errors: a committed file differs from a freshly generated one, is missing, or is no longer generated.
pub fn compare() -> Outcome {
    let fresh = root().join("target/generated");
    remove(&fresh)?;
    generate(&fresh)?;
    let (fresh, committed) = (read(&fresh)?, read(root())?);
    let names = fresh.keys().chain(committed.keys());
    match names.into_iter().find(|&name| fresh.get(name) != committed.get(name)) {
        None => {
            println!("{} generated files are as committed", fresh.len());
            Ok(())
        }
        Some(name) => {
            Err(format!("{} is not what is generated now; run `cargo xtask gen` and commit", name.display()))
        }
    }
}

fn generate(into: &Path) -> Outcome {
    shaders::write(into)?;
    api::write(into)?;
    WRITERS.iter().try_for_each(|(package, example)| {
        run(program("cargo run --quiet").args(["--package", package, "--example", example, "--"]).arg(into))
    })?;
    functions::write(into)
}

fn remove(path: &Path) -> Outcome {
    let removed = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    match removed {
        Err(error) if path.exists() => Err(format!("{} cannot be removed: {error}", path.display())),
        _ => Ok(()),
    }
}

/// All generated files below `base`, by their path below it.
fn read(base: &Path) -> Result<BTreeMap<PathBuf, Vec<u8>>, String> {
    let mut contents = BTreeMap::new();
    for place in GENERATED_PATHS {
        for path in files_below(&base.join(place))? {
            let bytes =
                fs::read(&path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
            contents.insert(path.strip_prefix(base).unwrap_or(&path).to_path_buf(), bytes);
        }
    }
    Ok(contents)
}

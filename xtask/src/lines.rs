//! `cargo xtask lines`: counts the lines of code of each part of the repository, without comments, blank
//! lines and unit tests.

use std::ffi::OsStr;
use std::path::{Component, Path};

use crate::run::{Outcome, files_below, root};

/// The parts, and their folders.
const GROUPS: [(&str, &[&str]); 13] = [
    ("core", &["crates/darboux/src"]),
    ("io", &["crates/darboux-io/src"]),
    ("check", &["crates/darboux-check/src"]),
    ("cli", &["crates/darboux-cli/src"]),
    ("bake", &["crates/darboux-bake/src"]),
    ("gpu", &["crates/darboux-gpu/src"]),
    ("render", &["crates/darboux-render/src"]),
    ("c", &["bindings/c/src", "bindings/c/mikktspace/src"]),
    ("js", &["bindings/js/src", "bindings/js/lib"]),
    ("python", &["bindings/python/src", "bindings/python/python"]),
    ("viewer", &["viewer/src", "viewer/wasm/src"]),
    ("xtask", &["xtask/src"]),
    ("conformance", &["conformance"]),
];

/// Folders and files that hold tests, data or code of others.
const LEFT_OUT: [&str; 6] = ["cases", "node_modules", "results", "target", "tests", "tests.rs"];

/// Prints the lines of each group and their sum. Errors: a file cannot be read.
pub fn print() -> Outcome {
    let mut total = 0;
    for (group, folders) in GROUPS {
        let lines = folders.iter().map(|folder| in_folder(folder)).sum::<Result<usize, String>>()?;
        total += lines;
        println!("{group:<12} {lines:>6}");
    }
    println!("{:<12} {total:>6}", "total");
    Ok(())
}

fn in_folder(folder: &str) -> Result<usize, String> {
    let is_counted = |path: &Path| {
        let inside = path.strip_prefix(root()).unwrap_or(path);
        !inside
            .components()
            .any(|part| LEFT_OUT.iter().any(|name| part == Component::Normal(OsStr::new(name))))
    };
    let files = files_below(&root().join(folder))?;
    files.iter().filter(|path| is_counted(path)).map(|path| in_file(path)).sum()
}

fn in_file(path: &Path) -> Result<usize, String> {
    let count = match path.extension().and_then(OsStr::to_str) {
        Some("rs") => of_rust,
        Some("ts" | "mjs" | "c" | "h" | "hpp") => of_c_like,
        Some("py") => of_python,
        _ => return Ok(0),
    };
    let text = std::fs::read(path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
    Ok(count(&mut String::from_utf8_lossy(&text).lines().map(str::trim).filter(|line| !line.is_empty())))
}

/// Counts up to the first unit tests, which end a file.
fn of_rust(lines: &mut dyn Iterator<Item = &str>) -> usize {
    lines.take_while(|line| !line.starts_with("#[cfg(test)]")).filter(|line| !line.starts_with("//")).count()
}

fn of_c_like(lines: &mut dyn Iterator<Item = &str>) -> usize {
    let mut is_comment = false;
    let mut is_code = |line: &str| {
        if is_comment || line.starts_with("/*") {
            is_comment = !line.contains("*/");
            return false;
        }
        !line.starts_with("//")
    };
    lines.filter(|line| is_code(line)).count()
}

fn of_python(lines: &mut dyn Iterator<Item = &str>) -> usize {
    lines.filter(|line| !line.starts_with('#')).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_tests_are_no_code() {
        assert_eq!(
            of_rust(&mut ["//! x", "fn a() {", "// y", "}", "#[cfg(test)]", "mod tests {}"].into_iter()),
            2
        );
        assert_eq!(of_c_like(&mut ["/* x", "y", "*/", "/** z */", "f();", "// w", "g();"].into_iter()), 2);
        assert_eq!(of_python(&mut ["# x", "f()"].into_iter()), 1);
    }
}

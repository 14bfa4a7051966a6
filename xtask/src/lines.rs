//! `cargo xtask lines`: counts the lines of code of each part of the repository, shaders and style sheets
//! included, without comments, blank lines, tests, benchmarks and examples.

use std::ffi::OsStr;
use std::path::{Component, Path};

use crate::run::{Outcome, files_below, root};

/// The parts, and their folders.
const GROUPS: [(&str, &[&str]); 12] = [
    ("core", &["crates/darboux"]),
    ("io", &["crates/darboux-io"]),
    ("check", &["crates/darboux-check"]),
    ("cli", &["crates/darboux-cli"]),
    ("bake", &["crates/darboux-bake"]),
    ("gpu", &["crates/darboux-gpu", "shaders"]),
    ("render", &["crates/darboux-render"]),
    ("bindings", &["bindings"]),
    ("viewer", &["viewer"]),
    ("site", &["site"]),
    ("xtask", &["xtask"]),
    ("conformance", &["conformance"]),
];

/// Folders that hold tests, data, results of builds or code of others.
const LEFT_OUT: [&str; 11] = [
    "benches",
    "cases",
    "dist",
    "examples",
    "fuzz",
    "node_modules",
    "public",
    "results",
    "target",
    "test",
    "tests",
];

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
    let files = files_below(&root().join(folder))?;
    files.iter().filter(|path| is_counted(path)).map(|path| in_file(path)).sum()
}

fn is_counted(path: &Path) -> bool {
    let inside = path.strip_prefix(root()).unwrap_or(path);
    let is_left_out =
        |part: Component| LEFT_OUT.iter().any(|name| part == Component::Normal(OsStr::new(name)));
    let name = path.file_name().and_then(OsStr::to_str).unwrap_or_default();
    let is_test = name == "tests.rs" || name.starts_with("test_") || name.contains(".test.");
    !is_test && !inside.components().any(is_left_out)
}

fn in_file(path: &Path) -> Result<usize, String> {
    let count = match path.extension().and_then(OsStr::to_str) {
        Some("rs") => of_rust,
        Some("c" | "cpp" | "css" | "h" | "hpp" | "html" | "js" | "mjs" | "ts" | "wgsl") => of_c_like,
        Some("py") => of_python,
        _ => return Ok(0),
    };
    let text = std::fs::read(path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
    Ok(count(&mut String::from_utf8_lossy(&text).lines().filter(|line| !line.trim().is_empty())))
}

/// Leaves out what is compiled for unit tests alone: a line or, to the brace in the same column, a block.
fn of_rust(lines: &mut dyn Iterator<Item = &str>) -> usize {
    let mut count = 0;
    while let Some(line) = lines.next() {
        if line.trim() == "#[cfg(test)]" {
            skip_item(lines);
        } else if !line.trim_start().starts_with("//") {
            count += 1;
        }
    }
    count
}

fn skip_item(mut lines: &mut dyn Iterator<Item = &str>) {
    let Some(first) = (&mut lines).find(|line| !line.trim_start().starts_with('#')) else { return };
    if first.ends_with('{') {
        let end = format!("{}}}", &first[..first.len() - first.trim_start().len()]);
        (&mut lines).find(|line| *line == end);
    }
}

fn of_c_like(lines: &mut dyn Iterator<Item = &str>) -> usize {
    let mut is_comment = false;
    let mut is_code = |line: &str| {
        let line = line.trim_start();
        if is_comment || line.starts_with("/*") {
            is_comment = !line.contains("*/");
            return false;
        }
        !line.starts_with("//")
    };
    lines.filter(|line| is_code(line)).count()
}

fn of_python(lines: &mut dyn Iterator<Item = &str>) -> usize {
    lines.filter(|line| !line.trim_start().starts_with('#')).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_tests_are_no_code() {
        let rust = "//! x\nfn a() {\n    // y\n}\n#[cfg(test)]\nmod tests {\n    f();\n}\n#[cfg(test)]\nuse \
             b;\nfn c() {}";
        assert_eq!(of_rust(&mut rust.lines()), 3);
        assert_eq!(of_c_like(&mut ["/* x", "y", "*/", "/** z */", "f();", "// w", "g();"].into_iter()), 2);
        assert_eq!(of_python(&mut ["# x", "f()"].into_iter()), 1);
    }
}

//! The committed instruction counts: no change makes the AVX2 or the 128-bit code slower unnoticed.
//!
//! Counts differ between compilers by more than changes do, so they hold for one version of rustc. Between
//! processors of x86-64 they do not: valgrind has AVX2 and no AVX-512.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::{Deserialize, Serialize};

use crate::instructions::{Counts, MESHES};

/// The engines whose counts are committed.
pub const ENGINES: [&str; 3] = ["darboux", "darboux-kept", "darboux-kept-128"];

/// How far a count may be from the committed one.
const TOLERANCE: f64 = 0.02;

/// What to do with the committed counts.
#[derive(Clone, Copy, clap::ValueEnum)]
pub enum Task {
    /// Compare new counts with them.
    Check,
    /// Replace them.
    Write,
}

/// The content of the file.
#[derive(Deserialize, PartialEq, Serialize)]
struct Baseline {
    /// The first line of `rustc --version`.
    compiler: String,
    /// Instructions per triangle, by mesh and engine.
    counts: BTreeMap<String, BTreeMap<String, f64>>,
}

/// Compares or writes what `count` returns. Errors: counts are missing, or differ by more than [`TOLERANCE`],
/// also when they are taken again: the keys of hash tables are random, and now and then a mesh with undecided
/// vertices takes some percent more or fewer instructions.
pub fn run(task: Task, count: impl Fn() -> Result<Vec<Counts>, String>) -> Result<(), String> {
    let counted = || Ok::<_, String>(Baseline { compiler: compiler()?, counts: by_mesh(&count()?)? });
    match task {
        Task::Write => write(&counted()?),
        Task::Check => {
            let committed = read()?;
            compare(&committed, &counted()?).or_else(|_| compare(&committed, &counted()?))
        }
    }
}

fn compare(old: &Baseline, new: &Baseline) -> Result<(), String> {
    if old.compiler != new.compiler {
        println!("not compared: the committed counts are of {}, and this is {}", old.compiler, new.compiler);
        return Ok(());
    }
    let differing = differences(old, new);
    if differing.is_empty() {
        return Ok(());
    }
    let advice = "if that is right, say why in the commit and run `cargo xtask bench --baseline write`";
    Err(format!("instructions per triangle have changed: {}; {advice}", differing.join(", ")))
}

/// A clause for each count that is new, missing, or too far from the old one.
fn differences(old: &Baseline, new: &Baseline) -> Vec<String> {
    let mut found = Vec::new();
    for (mesh, engines) in &new.counts {
        for (engine, &count) in engines {
            match old.counts.get(mesh).and_then(|engines| engines.get(engine)) {
                Some(&before) if (count / before - 1.0).abs() <= TOLERANCE => {}
                Some(before) => {
                    found.push(format!(
                        "{engine} on {mesh} {before} -> {count} ({:+.1} %)",
                        100.0 * (count / before - 1.0)
                    ));
                }
                None => found.push(format!("{engine} on {mesh} is not in the file")),
            }
        }
    }
    found
}

fn by_mesh(rows: &[Counts]) -> Result<BTreeMap<String, BTreeMap<String, f64>>, String> {
    let mut counts: BTreeMap<String, BTreeMap<String, f64>> = BTreeMap::new();
    for row in rows {
        for (mesh, count) in MESHES.iter().zip(&row.of_mesh) {
            let count = count.ok_or_else(|| format!("{} on {mesh} could not be counted", row.engine))?;
            let rounded = (10.0 * count).round() / 10.0;
            counts.entry((*mesh).to_owned()).or_default().insert(row.engine.to_owned(), rounded);
        }
    }
    Ok(counts)
}

fn compiler() -> Result<String, String> {
    let output = Command::new("rustc").arg("--version").output();
    let output = output.map_err(|error| format!("rustc --version: {error}"))?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("record/instructions.json")
}

fn read() -> Result<Baseline, String> {
    let path = path();
    let failed = |why: String| format!("{}: {why}; run `cargo xtask bench --baseline write`", path.display());
    let text = fs::read_to_string(&path).map_err(|error| failed(error.to_string()))?;
    serde_json::from_str(&text).map_err(|error| failed(error.to_string()))
}

fn write(baseline: &Baseline) -> Result<(), String> {
    let text = serde_json::to_string_pretty(baseline).map_err(|error| error.to_string())?;
    fs::write(path(), text + "\n").map_err(|error| format!("{} cannot be written: {error}", path().display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn baseline(count: f64) -> Baseline {
        let engines = BTreeMap::from([("darboux".to_owned(), count)]);
        Baseline { compiler: "rustc 1".to_owned(), counts: BTreeMap::from([("grid".to_owned(), engines)]) }
    }

    #[test]
    fn two_percent_pass_and_more_does_not() {
        for count in [98.5, 100.0, 101.5] {
            assert!(differences(&baseline(100.0), &baseline(count)).is_empty());
        }
        assert_eq!(differences(&baseline(100.0), &baseline(103.0)), ["darboux on grid 100 -> 103 (+3.0 %)"]);
        assert_eq!(differences(&baseline(100.0), &baseline(97.0)), ["darboux on grid 100 -> 97 (-3.0 %)"]);
        let empty = Baseline { counts: BTreeMap::new(), ..baseline(0.0) };
        assert_eq!(differences(&empty, &baseline(100.0)), ["darboux on grid is not in the file"]);
    }

    #[test]
    fn another_compiler_is_not_compared() {
        let other = Baseline { compiler: "rustc 2".to_owned(), ..baseline(1.0) };
        assert!(compare(&other, &baseline(100.0)).is_ok());
        assert!(compare(&baseline(1.0), &baseline(100.0)).is_err());
    }
}

//! Counts, progress, kept cases, and the summary.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::case::Case;
use super::child::ResourceUse;
use super::runner::Outcome;
use super::tree;

/// The counts of one kind of case.
#[derive(Default)]
struct Row {
    runs: usize,
    done: usize,
    refused: usize,
    /// Runs with another exit code, or ended by a signal.
    other: usize,
    signals: usize,
    reopened: usize,
    used: ResourceUse,
    broken: BTreeMap<&'static str, usize>,
}

/// The counts of a soak.
pub struct Report {
    start: Instant,
    duration: Duration,
    last_line: Duration,
    /// Where cases that broke a promise are kept.
    keep: PathBuf,
    rows: BTreeMap<String, Row>,
    subcommands: BTreeMap<String, usize>,
}

/// The time between two lines of progress.
const INTERVAL: Duration = Duration::from_secs(10);

/// How many cases are kept for each kind of case and of broken promise.
const MAX_KEPT: usize = 3;

impl Report {
    pub fn new(duration: Duration, keep: PathBuf) -> Self {
        let start = Instant::now();
        Self {
            start,
            duration,
            last_line: Duration::ZERO,
            keep,
            rows: BTreeMap::new(),
            subcommands: BTreeMap::new(),
        }
    }

    /// Whether the time is over.
    pub fn is_over(&self) -> bool {
        self.start.elapsed() >= self.duration
    }

    /// Counts a case, and keeps it if something was found. `reproduce` is the line that runs it again.
    /// Errors: it cannot be kept.
    pub fn add(
        &mut self,
        case: &Case,
        number: u64,
        outcome: &Outcome,
        reproduce: &str,
    ) -> Result<(), String> {
        let subcommand =
            case.arguments.first().map(|word| word.to_string_lossy().into_owned()).unwrap_or_default();
        *self.subcommands.entry(subcommand).or_default() += outcome.codes.len();
        let row = self.rows.entry(case.name.clone()).or_default();
        row.runs += outcome.codes.len();
        row.done += outcome.codes.iter().filter(|code| **code == Some(0)).count();
        row.refused += outcome.codes.iter().filter(|code| **code == Some(1)).count();
        row.other += outcome.codes.iter().filter(|code| !matches!(code, Some(0 | 1))).count();
        row.signals += outcome.signals;
        row.reopened += outcome.reopened;
        row.used.memory = row.used.memory.max(outcome.used.memory);
        row.used.processor = row.used.processor.max(outcome.used.processor);
        row.used.wall = row.used.wall.max(outcome.used.wall);
        for promise in &outcome.broken {
            let count = row.broken.entry(promise.kind).or_default();
            *count += 1;
            if *count <= MAX_KEPT {
                let name = format!("{number}-{}", promise.kind.replace(' ', "-"));
                println!("{}, {}: {}\n  {reproduce}", case.name, promise.kind, promise.detail.trim_end());
                keep(&self.keep.join(name), case, &promise.detail, reproduce)?;
            }
        }
        Ok(())
    }

    /// Prints a line from time to time.
    pub fn progress(&mut self) {
        let elapsed = self.start.elapsed();
        if elapsed - self.last_line >= INTERVAL {
            self.last_line = elapsed;
            let (runs, broken) = (self.runs(), self.broken());
            eprintln!("  {} s, {runs} runs, {broken} broken promises", elapsed.as_secs());
        }
    }

    fn runs(&self) -> usize {
        self.rows.values().map(|row| row.runs).sum()
    }

    /// Where cases that broke a promise are.
    pub fn kept_in(&self) -> &Path {
        &self.keep
    }

    /// The number of broken promises.
    pub fn broken(&self) -> usize {
        self.rows.values().flat_map(|row| row.broken.values()).sum()
    }

    /// Prints the tables.
    pub fn summary(&self) {
        println!(
            "\n{:<42} {:>7} {:>7} {:>7} {:>6} {:>7} {:>8} {:>6} {:>7}  broken promises",
            "cases", "runs", "exit 0", "exit 1", "other", "signals", "reopened", "MB", "CPU s"
        );
        for (name, row) in &self.rows {
            let broken: Vec<String> =
                row.broken.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
            println!(
                "{name:<42} {:>7} {:>7} {:>7} {:>6} {:>7} {:>8} {:>6} {:>7.2}  {}",
                row.runs,
                row.done,
                row.refused,
                row.other,
                row.signals,
                row.reopened,
                row.used.memory >> 20,
                row.used.processor.as_secs_f32(),
                broken.join(", ")
            );
        }
        let subcommands: Vec<String> =
            self.subcommands.iter().map(|(name, count)| format!("{name} {count}")).collect();
        println!("\nruns by subcommand: {}", subcommands.join(", "));
        let sum = |count: fn(&Row) -> usize| self.rows.values().map(count).sum::<usize>();
        println!(
            "{} runs in {:.1} minutes: {} done, {} refused, {} sent a signal; {} outputs read again; {} \
             broken promises",
            self.runs(),
            self.start.elapsed().as_secs_f32() / 60.0,
            sum(|row| row.done),
            sum(|row| row.refused),
            sum(|row| row.signals),
            sum(|row| row.reopened),
            self.broken()
        );
    }
}

/// Keeps the files of a case, a script that runs it, and what was found.
fn keep(folder: &Path, case: &Case, detail: &str, reproduce: &str) -> Result<(), String> {
    let cannot_write = |error: std::io::Error| format!("{} cannot be written: {error}", folder.display());
    tree::make(folder, case).map_err(cannot_write)?;
    fs::write(folder.join("found.txt"), format!("{}\n{detail}\n{reproduce}\n", case.name))
        .map_err(cannot_write)?;
    fs::write(folder.join("stdin"), &case.stdin).map_err(cannot_write)?;
    fs::write(folder.join("run.sh"), script(case)).map_err(cannot_write)
}

/// A script that runs the command line in the folder `work` beside it; `$DARBOUX` is the program.
fn script(case: &Case) -> Vec<u8> {
    let mut text = b"#!/bin/sh\ncd \"$(dirname \"$0\")/work\"\n".to_vec();
    for (name, value) in &case.variables {
        text.extend([format!("export {name}=").as_bytes(), &quoted(value.as_bytes()), b"\n"].concat());
    }
    text.extend(case.shell_limit.map_or(String::new(), |limit| format!("{limit}\n")).into_bytes());
    text.extend(b"exec \"${DARBOUX:-darboux}\"");
    for argument in &case.arguments {
        text.push(b' ');
        text.extend(quoted(argument.as_bytes()));
    }
    text.extend(b" < ../stdin\n");
    text
}

/// A word that a POSIX shell takes literally.
fn quoted(word: &[u8]) -> Vec<u8> {
    let mut quoted = vec![b'\''];
    for &byte in word {
        match byte {
            b'\'' => quoted.extend(br"'\''"),
            byte => quoted.push(byte),
        }
    }
    quoted.push(b'\'');
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soak::verdict::BrokenPromise;

    #[test]
    fn a_kept_case_runs_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut report = Report::new(Duration::ZERO, folder.path().to_owned());
        let mut case = Case::new(["it's $HOME"]).file("a.glb", "x");
        case.shell_limit = Some("ulimit -f 4");
        let broken = vec![BrokenPromise { kind: "left behind", detail: "x".into() }];
        let outcome = Outcome { codes: vec![Some(1)], broken, ..Outcome::default() };
        report.add(&case, 7, &outcome, "cargo xtask soak --case 7").expect("it is kept");
        assert_eq!((report.broken(), report.runs(), report.is_over()), (1, 1, true));
        let kept = folder.path().join("7-left-behind");
        assert_eq!(fs::read(kept.join("work/a.glb")).expect("a file"), b"x");
        let output =
            std::process::Command::new("sh").arg(kept.join("run.sh")).env("DARBOUX", "echo").output();
        assert_eq!(output.expect("a shell").stdout, b"it's $HOME\n");
    }
}

//! `cargo xtask gpu`: all that a machine with a GPU can show, into one file.

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use crate::run::{Outcome, output_of, program, root, shown};

/// A heading and what runs below it. Without an adapter the tests fail, as in continuous integration.
const STEPS: [(&str, &str); 5] = [
    ("Tests", "cargo test --release --package darboux-gpu --no-fail-fast -- --include-ignored --nocapture"),
    ("Tests of the command", "cargo test --release --package darboux-cli --test devices -- --nocapture"),
    ("Adapters against the core", "cargo run --quiet --release --package darboux-gpu --example report"),
    ("The command's list", "cargo run --quiet --release --package darboux-cli -- devices"),
    ("Times", "cargo run --quiet --profile bench-room --package darboux-gpu --example times --"),
];

/// Runs every step, whichever fails, and writes `benches/record/gpu/<adapter>.md`. `options` go to the last. Errors: what failed.
pub fn record(options: &[&str]) -> Outcome {
    let commit = output_of(&mut program("git describe --always --dirty --abbrev=10"))?;
    let commit = String::from_utf8_lossy(&commit).trim().to_owned();
    let mut text = format!("# `cargo xtask gpu` at {commit}\n");
    let mut failed = Vec::new();
    let mut adapter = "no-adapter".to_owned();
    for (heading, line) in STEPS {
        println!("--- {heading}");
        let mut command = program(line);
        command.env("CI", "1");
        let is_last = heading == "Times";
        command.args(if is_last { options } else { &[] });
        let (lines, succeeded) = lines_of(&mut command)?;
        let is_markdown = is_last || heading == "Adapters against the core";
        let kept = if is_markdown { lines } else { plain(&lines) };
        if let Some(name) = kept.first().filter(|_| is_last) {
            adapter = slug(name.split(',').next().unwrap_or(name));
        }
        if !succeeded {
            failed.push(heading);
        }
        let end = if succeeded { "" } else { "\n**failed**\n" };
        text += &format!("\n## {heading}\n\n    {}\n\n{}\n{end}", shown(&command), kept.join("\n"));
    }
    let path = root().join("benches/record/gpu").join(format!("{adapter}.md"));
    let folder = path.parent().map_or(Ok(()), fs::create_dir_all);
    folder
        .and_then(|()| fs::write(&path, text))
        .map_err(|error| format!("{} cannot be written: {error}", path.display()))?;
    println!("recorded in {}", path.display());
    if failed.is_empty() { Ok(()) } else { Err(format!("failed: {}", failed.join(", "))) }
}

/// Runs a program, passes on what it prints, and gives it, with whether it succeeded. Errors: it cannot start.
fn lines_of(command: &mut Command) -> Result<(Vec<String>, bool), String> {
    let fault = |error, command: &Command| format!("{} cannot start: {error}", shown(command));
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(|error| fault(error, command))?;
    let output = child.stdout.take().into_iter();
    let lines = output.flat_map(|output| BufReader::new(output).lines().map_while(Result::ok));
    let lines = lines.inspect(|line| println!("{line}")).collect();
    let status = child.wait().map_err(|error| format!("{} cannot be awaited: {error}", shown(command)))?;
    Ok((lines, status.success()))
}

/// Plain text in Markdown, without what says nothing.
fn plain(lines: &[String]) -> Vec<String> {
    let says_something = |line: &&String| !line.is_empty() && !line.starts_with("running ");
    lines.iter().filter(says_something).map(|line| format!("    {line}")).collect()
}

/// Lower-case letters and digits, a hyphen for each run of anything else.
fn slug(text: &str) -> String {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-").to_ascii_lowercase()
}

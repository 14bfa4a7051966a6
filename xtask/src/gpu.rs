//! `cargo xtask gpu`: records the tests, comparisons and times of a machine with a GPU in one folder.
//!
//! The programs are built first, into one folder together with this program. A machine without Rust and
//! without a network needs that folder and the repository only. Each step can be run alone, and writes its
//! results as it goes.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::run::{Outcome, files_below, output_of, program, root, shown, target_folder};

/// The parsed arguments.
#[derive(Debug, Default, PartialEq)]
pub struct Arguments<'a> {
    /// The steps to run; all of [`STEPS`] if none is named.
    steps: Vec<&'static Step>,
    /// Build the programs without running them.
    only_build: bool,
    /// The folder for records.
    out: Option<&'a str>,
    /// Arguments of the benchmark.
    options: Vec<&'a str>,
}

/// A group of programs to run.
#[derive(Debug, PartialEq)]
struct Step {
    name: &'static str,
    heading: &'static str,
    /// A program of the folder, or a folder of them.
    programs: &'static str,
    arguments: &'static str,
    is_markdown: bool,
}

/// All steps, quick ones first.
const STEPS: &[Step] = &[
    step("devices", "The command's list of adapters", "command/darboux", "devices"),
    step("tests", "Tests", "tests", "--show-output"),
    step("command", "Tests of the command", "command/devices", "--show-output"),
    Step { is_markdown: true, ..step("report", "Adapters against the core", "examples/report", "") },
    Step { is_markdown: true, ..step(TIMES, "Times", "examples/times", "") },
    step("long", "Tests that take minutes", "tests", "--show-output --ignored"),
];
const TIMES: &str = "times";

const fn step(
    name: &'static str,
    heading: &'static str,
    programs: &'static str,
    arguments: &'static str,
) -> Step {
    Step { name, heading, programs, arguments, is_markdown: false }
}

/// Folders, and what cargo builds into them.
const BUILDS: [(&str, &str); 3] = [
    ("tests", "test --no-run --package darboux-gpu --tests"),
    ("command", "test --no-run --package darboux-cli --test devices"),
    ("examples", "build --package darboux-gpu --example report --example times"),
];
/// The file in the folder of programs that names the commit they were built from.
const COMMIT: &str = "commit";

impl<'a> Arguments<'a> {
    /// Of words in any order: names of steps, `pack`, `--out FOLDER`, and options of the benchmark. Errors:
    /// `--out` without a folder, other words.
    pub fn new(words: &[&'a str]) -> Result<Self, String> {
        let mut wanted = Self::default();
        let mut words = words.iter().copied();
        while let Some(word) = words.next() {
            match word {
                "pack" => wanted.only_build = true,
                "--out" => wanted.out = Some(words.next().ok_or("--out needs a folder after it")?),
                _ if word == "--quick" || word.parse::<usize>().is_ok() => wanted.options.push(word),
                _ => wanted.steps.push(STEPS.iter().find(|step| step.name == word).ok_or_else(|| {
                    let names: Vec<_> = STEPS.iter().map(|step| step.name).collect();
                    format!("{word} is not a step of cargo xtask gpu; the steps are {}", names.join(", "))
                })?),
            }
        }
        if wanted.steps.is_empty() {
            wanted.steps.extend(STEPS);
        }
        Ok(wanted)
    }
}

/// Builds the programs unless this program was packed with them, runs all steps, and writes a file for each.
/// Errors: a step failed.
pub fn record(wanted: &Arguments<'_>) -> Outcome {
    let packed = std::env::current_exe().ok().and_then(|own| own.parent().map(Path::to_owned));
    let folder = match packed.filter(|folder| folder.join(COMMIT).is_file()) {
        Some(folder) => folder,
        None => build()?,
    };
    if wanted.only_build {
        println!("{}", folder.display());
        return Ok(());
    }
    if !root().join("conformance/cases").is_dir() {
        return Err(format!(
            "the tests read the repository at {}, where they were built: put it there, or a link to it",
            root().display()
        ));
    }
    let commit = read(&folder.join(COMMIT))?;
    let out = match wanted.out {
        Some(out) => PathBuf::from(out),
        None => root().join("benches/record/gpu").join(adapters(&folder)?).join(&commit),
    };
    fs::create_dir_all(&out).map_err(|error| format!("{} cannot be made: {error}", out.display()))?;
    let mut failed = Vec::new();
    for step in &wanted.steps {
        println!("--- {}", step.heading);
        let options = if step.name == TIMES { &wanted.options[..] } else { &[] };
        if !step.run(&folder, options, &out, &commit)? {
            failed.push(step.name);
        }
    }
    println!("recorded in {}", out.display());
    if failed.is_empty() { Ok(()) } else { Err(format!("failed: {}", failed.join(", "))) }
}

impl Step {
    /// Runs its programs and writes its file. False where one failed. Errors: the file cannot be written.
    fn run(&self, folder: &Path, options: &[&str], out: &Path, commit: &str) -> Result<bool, String> {
        let path = out.join(self.name).with_extension("md");
        let mut text = format!("# {}\n\n`cargo xtask gpu {}` at {commit}\n", self.heading, self.name);
        let mut succeeded = true;
        for file in files_below(&folder.join(self.programs))? {
            let mut command = Command::new(&file);
            command.current_dir(root()).stdin(Stdio::null());
            command.args(self.arguments.split_whitespace()).args(options);
            // Without an adapter the tests fail, as in continuous integration.
            command.env("CI", "1").env("DARBOUX_PROGRAM", folder.join("command/darboux"));
            let (lines, end) = lines_of(&mut command)?;
            let kept = if self.is_markdown { lines } else { plain(&lines) };
            let name = file.file_stem().unwrap_or_default().to_string_lossy();
            text += &format!("\n## {name}\n\n{}\n", kept.join("\n"));
            if let Some(end) = end {
                succeeded = false;
                text += &format!("\n**failed: {end}**\n");
            }
            fs::write(&path, &text)
                .map_err(|error| format!("{} cannot be written: {error}", path.display()))?;
        }
        Ok(succeeded)
    }
}

/// Builds all programs, and this one, into a folder. Errors: cargo fails; files cannot be copied.
fn build() -> Result<PathBuf, String> {
    let folder = target_folder()?.join("gpu");
    let cannot_write = |error| format!("{} cannot be written: {error}", folder.display());
    let own = std::env::current_exe().map_err(|error| format!("this program is not found: {error}"))?;
    for (name, line) in BUILDS {
        let into = folder.join(name);
        // A test that is gone must not run again.
        match fs::remove_dir_all(&into) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(cannot_write(error)),
            _ => fs::create_dir_all(&into).map_err(cannot_write)?,
        }
        let mut command = program("cargo");
        command.args(line.split_whitespace());
        command.args(["--profile", "bench-room", "--message-format", "json-render-diagnostics"]);
        command.env("CARGO_PROFILE_BENCH_ROOM_STRIP", "symbols");
        for (target, executable) in executables(&output_of(&mut command)?) {
            let to = into.join(target).with_extension(executable.extension().unwrap_or_default());
            fs::copy(&executable, to).map_err(cannot_write)?;
        }
    }
    fs::copy(&own, folder.join("xtask").with_extension(own.extension().unwrap_or_default()))
        .map_err(cannot_write)?;
    let commit = output_of(&mut program("git describe --always --dirty --abbrev=10"))?;
    fs::write(folder.join(COMMIT), String::from_utf8_lossy(&commit).trim()).map_err(cannot_write)?;
    Ok(folder)
}

/// Names and paths of the programs in cargo's messages.
fn executables(messages: &[u8]) -> Vec<(String, PathBuf)> {
    let executable = |line: &[u8]| {
        let message: serde_json::Value = serde_json::from_slice(line).ok()?;
        let path = message["executable"].as_str()?;
        Some((message["target"]["name"].as_str()?.to_owned(), path.into()))
    };
    messages.split(|byte| *byte == b'\n').filter_map(executable).collect()
}

/// The adapters' names as a folder name.
fn adapters(folder: &Path) -> Result<String, String> {
    let mut command = Command::new(folder.join("command/darboux"));
    let text = output_of(command.args(["devices", "--json"]))?;
    let report: serde_json::Value =
        serde_json::from_slice(&text).map_err(|error| format!("darboux devices --json: {error}"))?;
    let names = report["adapters"].as_array().into_iter().flatten();
    let names: Vec<String> = names.filter_map(|adapter| adapter["name"].as_str()).map(slug).collect();
    Ok(if names.is_empty() { "no-adapter".to_owned() } else { names.join("+") })
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{} cannot be read: {error}", path.display()))
}

/// Runs a program, prints its output, and returns the lines and, if it failed, its exit status. Errors: it
/// cannot start.
fn lines_of(command: &mut Command) -> Result<(Vec<String>, Option<String>), String> {
    let cannot_start = |error, command: &Command| format!("{} cannot start: {error}", shown(command));
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(|error| cannot_start(error, command))?;
    let output = child.stdout.take().into_iter();
    let lines = output.flat_map(|output| BufReader::new(output).lines().map_while(Result::ok));
    let lines = lines.inspect(|line| println!("{line}")).collect();
    let status = child.wait().map_err(|error| format!("{} cannot be awaited: {error}", shown(command)))?;
    Ok((lines, (!status.success()).then(|| status.to_string())))
}

/// Plain text as Markdown code, without blank lines and lines that only say that tests run.
fn plain(lines: &[String]) -> Vec<String> {
    let says_something = |line: &&String| !line.is_empty() && !line.starts_with("running ");
    lines.iter().filter(says_something).map(|line| format!("    {line}")).collect()
}

/// Lower-case letters and digits, a hyphen for each run of anything else.
fn slug(text: &str) -> String {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-").to_ascii_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_steps_and_what_the_benchmark_takes() {
        let wanted = Arguments::new(&["tests", "--quick", "times", "--out", "here", "2000"]).expect("fine");
        let steps: Vec<_> = wanted.steps.iter().map(|step| step.name).collect();
        assert_eq!((&steps[..], wanted.out), (&["tests", "times"][..], Some("here")));
        assert_eq!(wanted.options, ["--quick", "2000"]);
        assert_eq!(Arguments::new(&[]).expect("fine").steps.len(), STEPS.len());
        assert!(Arguments::new(&["--out"]).is_err());
        assert!(Arguments::new(&["test"]).is_err_and(|why| why.starts_with("test is not a step")));
    }

    #[test]
    fn programs_are_found_among_messages() {
        let messages = b"{\"reason\":\"compiler-artifact\",\"target\":{\"name\":\"plan\"},\"executable\":\"/a/plan-1\"}\n\
            {\"reason\":\"compiler-artifact\",\"target\":{\"name\":\"darboux\"},\"executable\":null}\n\
            {\"reason\":\"build-finished\",\"success\":true}\n";
        assert_eq!(executables(messages), [("plan".to_owned(), PathBuf::from("/a/plan-1"))]);
    }
}

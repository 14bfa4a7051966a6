//! What commands that write files have in common: from arguments to the exit code, one file after the other.

use std::path::Path;
use std::time::Instant;

use indicatif::HumanCount;
use serde::Serialize;

use crate::arguments::{Files, Talk};
use crate::jobs::{self, Input, Job, Output, Rules, Scan, Usage};
use crate::messages::{Messages, stdout_is_terminal, write_stdout};
use crate::report::{FileReport, Report, Status, to_json};
use crate::{exit, interrupt};

/// A command that writes one output for each input.
pub trait Work {
    /// What its report says of a file, beyond what it says of all.
    type Summary: Default + Serialize;

    /// Its name.
    const COMMAND: &'static str;
    /// Whether it takes images as well as models.
    const IMAGES: bool;

    /// What the names of its outputs get.
    fn word(&self) -> &str;

    /// Which files.
    fn files(&self) -> &Files;

    /// To whom it talks.
    fn talk(&self) -> &Talk;

    /// What does not fit together.
    fn check(&self) -> Result<(), Usage>;

    /// Reads, changes, writes. Errors are one sentence each.
    fn process(&self, job: &Job, messages: &Messages) -> Result<Made<Self::Summary>, String>;

    /// What was done to the parts of a file, one line each.
    fn lines(summary: &Self::Summary) -> Vec<String>;

    /// What a user should look at, one sentence each.
    fn warnings(summary: &Self::Summary) -> &[String];

    /// The last line: what became of all files.
    fn total(files: &[FileReport<Self::Summary>]) -> String;
}

/// What was made of one file.
pub struct Made<S> {
    pub status: Status,
    pub files_written: Vec<String>,
    pub summary: S,
}

/// Runs a command; gives its exit code.
pub fn run<W: Work>(command: &W) -> u8 {
    let start = Instant::now();
    let messages = Messages::new(command.talk().quiet);
    let files = command.files();
    let found = jobs::find(&files.inputs, Scan::Sources { out_dir: files.out_dir.as_deref() });
    let rules = Rules { word: command.word(), json: command.talk().json, images: W::IMAGES };
    let plan = |()| jobs::plan(files, rules, &found);
    let jobs = match command.check().and_then(plan).and_then(refuse_terminal) {
        Ok(jobs) => jobs,
        Err(Usage(sentence)) => {
            messages.error(&sentence);
            return exit::USAGE;
        }
    };
    if found.left_out > 0 {
        let left_out = counted(found.left_out, "file", "files");
        messages.say(&format!("{left_out} left out: earlier outputs, by their names"));
    }
    interrupt::wait_for_writes();
    messages.start(jobs.iter().map(|job| size_of(&job.input)).sum());
    let unsearched = found.failed.into_iter().map(|(path, reason)| {
        let path = path.display().to_string();
        let sentence = format!("{path}: {reason}");
        FileReport::failed(path, sentence)
    });
    let mut files: Vec<FileReport<W::Summary>> = unsearched.collect();
    for job in &jobs {
        files.push(work(command, job, &messages));
    }
    messages.end_progress();
    finish::<W>(Report::new(W::COMMAND, files), command.talk().json, &messages, start)
}

fn refuse_terminal(jobs: Vec<Job>) -> Result<Vec<Job>, Usage> {
    if jobs.iter().any(|job| job.output == Output::Stdout) && stdout_is_terminal() {
        return Err(Usage("such a file is not for a terminal; use -o FILE, or > FILE".into()));
    }
    Ok(jobs)
}

/// One file's work, told as it ends. Its error, if any, is told at the end of all.
fn work<W: Work>(command: &W, job: &Job, messages: &Messages) -> FileReport<W::Summary> {
    messages.start_file(&job.input.to_string(), size_of(&job.input));
    let made = refuse_existing(&job.output, command.files()).and_then(|()| command.process(job, messages));
    messages.end_file();
    let input = job.input.to_string();
    match made {
        Ok(Made { status, files_written, summary }) => {
            let output = Some(job.output.to_string());
            let report = FileReport { input, output, status, error: None, files_written, summary };
            tell::<W>(&report, messages);
            report
        }
        Err(sentence) => FileReport::failed(input, sentence),
    }
}

/// Says before any work that an output is in the way.
fn refuse_existing(output: &Output, files: &Files) -> Result<(), String> {
    match output {
        Output::File(path) if path.exists() && !files.force && !files.in_place => {
            Err(format!("{output}: exists; use --force to replace it, or name another output"))
        }
        _ => Ok(()),
    }
}

/// Tells what was done to a file.
fn tell<W: Work>(report: &FileReport<W::Summary>, messages: &Messages) {
    let (Some(output), FileReport { input, summary, .. }) = (&report.output, report) else { return };
    match report.status {
        Status::Written | Status::Copied if input != output => messages.say(&format!("{input} -> {output}")),
        Status::Untouched => messages.say(&format!("{input}: nothing to do, left as it was")),
        _ => messages.say(input),
    }
    W::lines(summary).iter().for_each(|line| messages.say(&format!("  {line}")));
    W::warnings(summary).iter().for_each(|warning| messages.warn(&format!("{input}: {warning}")));
}

fn finish<W: Work>(report: Report<W::Summary>, json: bool, messages: &Messages, start: Instant) -> u8 {
    for error in report.files.iter().filter_map(|file| file.error.as_ref()) {
        messages.error(error);
    }
    let totals = &report.totals;
    if totals.failed < totals.files || totals.files > 1 {
        let done = counted(totals.files - totals.failed, "file", "files");
        let failed = match totals.failed {
            0 => String::new(),
            failed => format!(", {} failed", counted(failed, "file", "files")),
        };
        let seconds = start.elapsed().as_secs_f32();
        messages.say(&format!("{} in {done}{failed}; {seconds:.2} s", W::total(&report.files)));
    }
    if json {
        let written = to_json(&report).map_err(std::io::Error::from).and_then(|text| write_stdout(&text));
        if let Err(error) = written {
            messages.error(&format!("the report cannot be written: {error}"));
            return exit::FAILED;
        }
    }
    if report.totals.failed > 0 { exit::FAILED } else { exit::DONE }
}

/// A number with its noun.
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{} {}", HumanCount(count as u64), if count == 1 { one } else { many })
}

/// ", 3 things" for each count that is not zero.
pub fn remarks<'a>(counts: impl IntoIterator<Item = (usize, &'a str, &'a str)>) -> String {
    let counts = counts.into_iter().filter(|count| count.0 > 0);
    counts.map(|(count, one, many)| format!(", {}", counted(count, one, many))).collect()
}

/// The size of an input in bytes; 0 where it is not known.
pub fn size_of(input: &Input) -> u64 {
    match input {
        Input::File(path) => Path::metadata(path).map_or(0, |metadata| metadata.len()),
        Input::Stdin => 0,
    }
}

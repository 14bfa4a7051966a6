//! What commands that write files have in common: from arguments to the exit code, so many files at a time.

mod one_file;

use std::iter;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

use indicatif::HumanCount;
use serde::Serialize;

use crate::arguments::{Files, Talk};
use crate::jobs::{self, Input, Job, Output, Rules, Scan, Usage};
use crate::journal::Journal;
use crate::messages::{FileProgress, Messages, stdout_is_terminal, write_stdout};
use crate::report::{FileReport, Report, Status, to_json};
use crate::{exit, interrupt};

pub use one_file::{Done, Known, work};

/// A command that writes one output for each input.
pub trait Work: Sync {
    /// What its report says of a file, beyond what it says of all.
    type Summary: Default + Send + Serialize;

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

    /// The options that decide outputs, as text in which any difference shows.
    fn options(&self) -> String;

    /// Reads, changes, writes. Errors are one sentence each.
    fn process(&self, job: &Job, progress: &FileProgress<'_>) -> Result<Made<Self::Summary>, String>;

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
    let folder = files.out_dir.as_deref().filter(|_| files.resume);
    let journal = folder.map(|folder| Journal::open(folder, files.run)).transpose();
    let done = journal.and_then(|journal| work_all(command, &jobs, journal.as_ref(), &messages));
    messages.end_progress();
    match done {
        Ok(done) => {
            let files = found.failed.into_iter().map(unsearched).chain(done).collect();
            finish::<W>(Report::new(W::COMMAND, files), command.talk().json, &messages, start)
        }
        Err(sentence) => {
            messages.error(&sentence);
            exit::FAILED
        }
    }
}

/// The report of a place that could not be searched.
pub fn unsearched<S: Default>((path, reason): (PathBuf, String)) -> FileReport<S> {
    let path = path.display().to_string();
    let sentence = format!("{path}: {reason}");
    FileReport::failed(path, sentence)
}

fn refuse_terminal(jobs: Vec<Job>) -> Result<Vec<Job>, Usage> {
    if jobs.iter().any(|job| job.output == Output::Stdout) && stdout_is_terminal() {
        return Err(Usage("such a file is not for a terminal; use -o FILE, or > FILE".into()));
    }
    Ok(jobs)
}

/// Works on the files, so many at a time. Each is told of and journalled as it ends; reports come in the order of the jobs.
fn work_all<W: Work>(
    command: &W,
    jobs: &[Job],
    journal: Option<&Journal>,
    messages: &Messages,
) -> Result<Vec<FileReport<W::Summary>>, String> {
    let workers = usize::from(command.files().jobs.get()).min(jobs.len());
    let next = AtomicUsize::new(0);
    let mut reports: Vec<Option<FileReport<W::Summary>>> = jobs.iter().map(|_| None).collect();
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..workers {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || {
                let take = || next.fetch_add(1, Ordering::Relaxed);
                let jobs = iter::repeat_with(take).map_while(|at| Some((at, jobs.get(at)?)));
                for (at, job) in jobs {
                    let done = work(command, job, known(journal, job), messages);
                    // Nobody listens any more after an error of the journal.
                    if sender.send((at, done)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        for (at, Done { report, record }) in receiver {
            if let (Some(journal), Some(record)) = (journal, record) {
                journal.add(&record)?;
            }
            tell::<W>(&report, messages);
            reports[at] = Some(report);
        }
        Ok(reports.into_iter().flatten().collect())
    })
}

/// What the journal knows of a job.
fn known<'a>(journal: Option<&'a Journal>, job: &Job) -> Option<Known<'a>> {
    let journal = journal?;
    let record = match &job.output {
        Output::File(output) => journal.find(output),
        Output::Stdout => None,
    };
    Some(Known { folder: journal.folder(), record })
}

/// Tells what was done to a file.
fn tell<W: Work>(report: &FileReport<W::Summary>, messages: &Messages) {
    let (Some(output), FileReport { input, summary, .. }) = (&report.output, report) else { return };
    let Some(summary) = summary.now() else { return messages.say(&format!("{input}: up to date")) };
    match report.status {
        Status::Copied => messages.say(&format!("{input} -> {output}: nothing changes, a copy")),
        Status::Written if input != output => messages.say(&format!("{input} -> {output}")),
        Status::Untouched => messages.say(&format!("{input}: nothing changes, left as it was")),
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

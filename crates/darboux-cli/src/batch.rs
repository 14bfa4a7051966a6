//! Runs a subcommand that writes files: plans the jobs, processes them on several threads, prints messages and the report.

pub mod command;
mod journal;
pub mod library;
mod one_file;
pub mod plan;
pub mod report;

use std::iter;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

use crate::inputs::{SearchMode, UsageError, find_inputs};
use crate::json::to_json;
use crate::terminal::{Messages, stdout_is_terminal, write_stdout};
use crate::text::counted;
use crate::{exit, interrupt};
use command::FileCommand;
use journal::Journal;
use one_file::{FinishedFile, JournalEntry, process_file};
use plan::{Job, Output, OutputRules, plan_jobs};
use report::{BatchReport, FileReport, Status};

/// Runs a command and returns its exit code.
pub fn run<W: FileCommand>(command: &W) -> u8 {
    let start = Instant::now();
    let messages = Messages::new(command.messages().quiet);
    let files = command.files();
    let found = find_inputs(&files.inputs, SearchMode::SkipOutputs { out_dir: files.out_dir.as_deref() });
    let rules = OutputRules { suffix: command.suffix(), json: command.messages().json, images: W::IMAGES };
    let plan = |()| plan_jobs(files, rules, &found);
    let jobs = match command.check().and_then(plan).and_then(refuse_terminal) {
        Ok(jobs) => jobs,
        Err(UsageError(sentence)) => {
            messages.error(&sentence);
            return exit::USAGE;
        }
    };
    if found.skipped > 0 {
        let skipped = counted(found.skipped, "file", "files");
        messages.say(&format!("{skipped} skipped: named like outputs of an earlier run"));
    }
    interrupt::wait_for_writes();
    messages.start(jobs.iter().map(|job| job.input.byte_length()).sum());
    let folder = files.out_dir.as_deref().filter(|_| files.resume);
    let journal = folder.map(|folder| Journal::open(folder, files.run)).transpose();
    let reports = journal.and_then(|journal| process_all(command, &jobs, journal.as_ref(), &messages));
    messages.end_progress();
    match reports {
        Ok(reports) => {
            let files = found.failed.into_iter().map(FileReport::not_searched).chain(reports).collect();
            finish::<W>(BatchReport::new(W::NAME, files), command.messages().json, &messages, start)
        }
        Err(sentence) => {
            messages.error(&sentence);
            exit::FAILED
        }
    }
}

fn refuse_terminal(jobs: Vec<Job>) -> Result<Vec<Job>, UsageError> {
    if jobs.iter().any(|job| job.output == Output::Stdout) && stdout_is_terminal() {
        return Err(UsageError("a model cannot be written to a terminal; use -o FILE, or > FILE".into()));
    }
    Ok(jobs)
}

/// Processes the files on `--jobs` threads. The messages and the journal record of a file are written when the file is finished; the
/// reports are in the order of the jobs.
fn process_all<W: FileCommand>(
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
                    let finished = process_file(command, job, journal_entry(journal, job), messages);
                    // The receiver is dropped when the journal cannot be written.
                    if sender.send((at, finished)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        for (at, FinishedFile { report, record }) in receiver {
            if let (Some(journal), Some(record)) = (journal, record) {
                journal.add(&record)?;
            }
            print_file::<W>(&report, messages);
            reports[at] = Some(report);
        }
        Ok(reports.into_iter().flatten().collect())
    })
}

/// The journal's entry for a job.
fn journal_entry<'a>(journal: Option<&'a Journal>, job: &Job) -> Option<JournalEntry<'a>> {
    let journal = journal?;
    let record = match &job.output {
        Output::File(output) => journal.find(output),
        Output::Stdout => None,
    };
    Some(JournalEntry { folder: journal.folder(), record })
}

/// Prints what was done to a file.
fn print_file<W: FileCommand>(report: &FileReport<W::Summary>, messages: &Messages) {
    let (Some(output), FileReport { input, summary, .. }) = (&report.output, report) else { return };
    let Some(summary) = summary.this_run() else { return messages.say(&format!("{input}: up to date")) };
    match report.status {
        Status::Copied => messages.say(&format!("{input} -> {output}: nothing changes, a copy")),
        Status::Written if input != output => messages.say(&format!("{input} -> {output}")),
        Status::Untouched => messages.say(&format!("{input}: nothing changes, left as it was")),
        _ => messages.say(input),
    }
    W::lines(summary).iter().for_each(|line| messages.say(&format!("  {line}")));
    W::warnings(summary).iter().for_each(|warning| messages.warn(&format!("{input}: {warning}")));
}

fn finish<W: FileCommand>(
    report: BatchReport<W::Summary>,
    json: bool,
    messages: &Messages,
    start: Instant,
) -> u8 {
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

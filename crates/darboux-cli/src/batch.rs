//! Runs a subcommand that writes files: plans the jobs, processes them on several threads, prints messages
//! and the report.
//!
//! The results of a file do not depend on the other files, and messages and reports come in the order of the
//! inputs. So the output is the same for every number of threads.

pub mod command;
pub mod distributed;
pub mod journal;
pub mod one_file;
pub mod plan;
pub mod report;
mod tally;
pub mod task_result;

use std::collections::BTreeMap;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

use crate::inputs::{SearchMode, UsageError, find_inputs};
use crate::memory::JobMemory;
use crate::paths::canonical;
use crate::terminal::{Messages, stdout_is_terminal};
use crate::text::{counted, nonzero_counts};
use crate::{exit, interrupt};
use command::FileCommand;
use journal::{Earlier, Journal, skipped};
use one_file::{FinishedFile, JournalEntry, process_file, refuse_foreign};
use plan::{Job, Output, OutputRules, plan_jobs};
use report::{FileReport, Status, SummarySource};
use tally::Tally;

/// With more files than this, each file gets one line.
pub const MAX_DETAILED_FILES: usize = 10;

/// Runs a command and returns its exit code.
pub fn run<W: FileCommand>(command: &W) -> u8 {
    let start = Instant::now();
    let messages = Messages::new(command.messages().quiet);
    let files = command.files();
    let mode = SearchMode::SkipOutputs { out_dir: files.out_dir.as_deref(), in_place: files.in_place };
    let found = find_inputs(&files.inputs, mode);
    let rules = OutputRules { suffix: command.suffix(), json: command.messages().json, images: W::IMAGES };
    let plan = |()| plan_jobs(files, rules, &found);
    let jobs = match command.check().and_then(plan).and_then(refuse_terminal) {
        Ok(jobs) => jobs,
        Err(UsageError(sentence)) => {
            messages.error(&sentence);
            return exit::USAGE;
        }
    };
    if let Some(sentence) = skipped_outputs(&found.skipped) {
        messages.say(&sentence);
    }
    found.unread.iter().for_each(|sentence| messages.warn(sentence));
    interrupt::wait_for_writes();
    messages.start(jobs.iter().map(|job| job.input.byte_length()).sum());
    let folder = files.out_dir.as_deref().filter(|_| files.resume);
    let journal = folder.map(|folder| Journal::open(folder, files.run)).transpose();
    let journal = match journal {
        Ok(journal) => journal,
        Err(sentence) => {
            messages.end_progress();
            messages.error(&sentence);
            return exit::FAILED;
        }
    };
    let _note = journal.as_ref().and_then(Journal::note_interrupts);
    let mut tally = Tally::new(command, is_brief(command, jobs.len()));
    found.failed.into_iter().map(FileReport::not_searched).for_each(|report| tally.add(&report));
    let processed = process_all(command, &jobs, journal.as_ref(), &messages, &mut tally);
    messages.end_progress();
    tally.finish(processed, &messages, start)
}

/// The message about files of a folder that are named like outputs of earlier runs.
fn skipped_outputs(skipped: &[PathBuf]) -> Option<String> {
    let (first, others) = skipped.split_first()?;
    let others = match others.len() {
        0 => String::new(),
        others => format!(" and {}", counted(others, "other file", "other files")),
    };
    let first = first.display();
    Some(format!(
        "{first}{others} skipped: named like outputs of an earlier run; name such a file to process it"
    ))
}

fn refuse_terminal(jobs: Vec<Job>) -> Result<Vec<Job>, UsageError> {
    if jobs.iter().any(|job| job.output == Output::Stdout) && stdout_is_terminal() {
        return Err(UsageError("a model cannot be written to a terminal; use -o FILE, or > FILE".into()));
    }
    Ok(jobs)
}

/// Processes the files on several threads, then one by one those during which an earlier run was killed.
/// Messages and reports come in the order of the jobs.
fn process_all<W: FileCommand>(
    command: &W,
    jobs: &[Job],
    journal: Option<&Journal>,
    messages: &Messages,
    tally: &mut Tally<'_, W>,
) -> Result<(), String> {
    let next = AtomicUsize::new(0);
    let memory = JobMemory::of_process();
    let work = Work { command, journal, memory: &memory, messages };
    let (together, alone): (Vec<usize>, Vec<usize>) =
        (0..jobs.len()).partition(|&index| work.earlier(&jobs[index]) == Earlier::Harmless);
    let process_next = || {
        let index = *together.get(next.fetch_add(1, Ordering::Relaxed))?;
        Some((index, work.process(&jobs[index])))
    };
    let mut results = Results { messages, tally, waiting: BTreeMap::new(), printed: 0 };
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        let mut workers = 0;
        // A single worker is this thread, below: glibc grows the memory of other threads page by page.
        let wanted = Some(worker_count(command, together.len())).filter(|&wanted| wanted > 1);
        while workers < wanted.unwrap_or_default() {
            let (sender, process_next) = (sender.clone(), &process_next);
            // The receiver is dropped when the journal cannot be written.
            let work = move || while process_next().is_some_and(|finished| sender.send(finished).is_ok()) {};
            if thread::Builder::new().spawn_scoped(scope, work).is_err() {
                break;
            }
            workers += 1;
        }
        drop(sender);
        for (index, finished) in receiver {
            results.add(index, finished?);
        }
        Ok(())
    })
    .and_then(|()| {
        // Without any worker, for one file or where no thread can be started, this thread processes the
        // files.
        while let Some((index, finished)) = process_next() {
            results.add(index, finished?);
        }
        // If one of these ends the process, the others are done, and the journal names this one alone.
        for index in alone {
            results.add(index, work.process(&jobs[index])?);
        }
        Ok(())
    })
}

/// What the work on every file needs.
struct Work<'a, W> {
    command: &'a W,
    journal: Option<&'a Journal>,
    memory: &'a JobMemory,
    messages: &'a Messages,
}

impl<W: FileCommand> Work<'_, W> {
    /// What earlier runs say about a job.
    fn earlier(&self, job: &Job) -> Earlier {
        self.journaled(job).map_or(Earlier::Harmless, |(journal, output)| journal.earlier(output))
    }

    /// The journal, and the output that it knows the job by.
    fn journaled<'j>(&self, job: &'j Job) -> Option<(&Journal, &'j Path)> {
        match &job.output {
            Output::File(output) => Some((self.journal?, output)),
            Output::Stdout => None,
        }
    }

    /// Processes a file, and writes the journal. Errors: the journal cannot be written.
    fn process(&self, job: &Job) -> Result<FileReport<W::Summary>, String> {
        let options = || self.command.files().reading.load_options();
        let _share = self.memory.wait_for(|| job.input.memory(&options()));
        let entry = self.journal.map(|journal| JournalEntry::new(journal, job));
        let work = || {
            let FinishedFile { report, record } = process_file(self.command, job, entry, self.messages);
            (report, record)
        };
        let failed = |sentence| FileReport::failed(job.input.to_string(), sentence);
        let Some((journal, output)) = self.journaled(job) else { return Ok(work().0) };
        if let Err(sentence) = refuse_foreign(self.command, job, entry) {
            return Ok(failed(sentence));
        }
        let done = journal.around(output, self.command.files().retry, work)?;
        Ok(done.unwrap_or_else(|| failed(skipped(&job.input))))
    }
}

/// The number of threads: one per core unless `--jobs` says otherwise.
fn worker_count(command: &impl FileCommand, jobs: usize) -> usize {
    let cores = || thread::available_parallelism().map_or(1, NonZero::get);
    command.files().jobs.map_or_else(cores, |jobs| usize::from(jobs.get())).min(jobs)
}

/// Whether each file gets one line.
fn is_brief(command: &impl FileCommand, files: usize) -> bool {
    files > MAX_DETAILED_FILES && !command.files().verbose
}

/// Takes finished files, which arrive in any order, and prints and counts them in the order of the jobs. Then
/// they are dropped, so that a run over many files does not need more and more memory.
struct Results<'a, 'w, W: FileCommand> {
    messages: &'a Messages,
    tally: &'a mut Tally<'w, W>,
    /// The reports of finished files that come after one that is not finished, by the numbers of their jobs.
    waiting: BTreeMap<usize, FileReport<W::Summary>>,
    /// The number of leading reports that were printed.
    printed: usize,
}

impl<W: FileCommand> Results<'_, '_, W> {
    fn add(&mut self, index: usize, report: FileReport<W::Summary>) {
        self.waiting.insert(index, report);
        while let Some(report) = self.waiting.remove(&self.printed) {
            print_file::<W>(&report, self.tally.brief, self.messages);
            self.tally.add(&report);
            self.printed += 1;
        }
    }
}

/// Prints what was done to a file. `brief`: in one line, with the number of warnings.
fn print_file<W: FileCommand>(report: &FileReport<W::Summary>, brief: bool, messages: &Messages) {
    let (Some(output), FileReport { input, summary, .. }) = (&report.output, report) else { return };
    let summary = match summary {
        SummarySource::ThisRun(summary) => summary,
        SummarySource::Journal(recorded) => {
            let note = W::note_up_to_date(recorded).map(|note| format!(", {note}")).unwrap_or_default();
            return messages.say(&format!("{input}: up to date{note}"));
        }
    };
    let outcome = match report.status {
        Status::Copied => format!("{input} -> {output}: unchanged copy"),
        Status::Written if input != output => format!("{input} -> {output}"),
        Status::Untouched => format!("{input}: unchanged, not written"),
        Status::UpToDate => format!("{input} -> {output}: up to date, not written"),
        _ => input.clone(),
    };
    let warnings = W::warnings(summary);
    if brief {
        let separator = if report.status == Status::Written { ": " } else { ", " };
        let mut counts = W::Totals::default();
        W::count(&mut counts, report);
        let total = W::total(&counts);
        let warnings = nonzero_counts([(warnings.len(), "warning", "warnings")]);
        return messages.say(&format!("{outcome}{separator}{total}{warnings}"));
    }
    messages.say(&outcome);
    let is_output = |file: &str| canonical(Path::new(file)) == canonical(Path::new(output));
    let written = report.files_written.iter().map(String::as_str);
    let further: Vec<&str> = written.filter(|file| !is_output(file)).collect();
    if !further.is_empty() {
        messages.say(&format!("  also written: {}", further.join(", ")));
    }
    W::lines(summary).iter().for_each(|line| messages.say(&format!("  {line}")));
    warnings.iter().for_each(|warning| messages.warn(&format!("{input}: {warning}")));
}

//! `darboux bake JOB --resume` in steps, for programs that distribute the entries to their own workers, as
//! [`DistributedBatch`](crate::DistributedBatch) does for files.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Parser;
use darboux_io::RunId;
use serde::{Deserialize, Serialize};

use super::entry::Entry;
use super::run::{BakedEntry, Recorded, arguments_of, bake_entry, check_entries, folder_of};
use super::{Work, work_of};
use crate::batch::journal::{Journal, Record};
use crate::batch::task_result::{record, sentence_of};
use crate::command_line::{Arguments, Command};
use crate::commands::bake::arguments::BakeArguments;
use crate::commands::bake::outputs::all_outputs;
use crate::commands::bake::report::BakeReport;
use crate::commands::bake::tile_names::has_place;
use crate::net;
use crate::options::files::new_run;
use crate::terminal::Messages;

/// A job with its locked journal, and one task per entry.
pub struct DistributedJob {
    journal: Journal,
    tasks: Vec<String>,
}

/// The work on one entry.
#[derive(Serialize, Deserialize)]
pub struct BakeTask {
    run: u64,
    /// The TOML file or the folder.
    job: PathBuf,
    /// Of the command.
    options: Vec<String>,
    /// The number of the entry, and its options as they were when the task was made.
    entry: usize,
    entry_options: String,
    low: PathBuf,
    output: PathBuf,
    record: Option<Record>,
    /// Whether an earlier run may have written the outputs without leaving a record.
    may_have_written: bool,
}

/// The result of a task.
#[derive(Serialize)]
struct TaskResult {
    report: EntryReport,
    record: Option<Record>,
}

/// What became of an entry.
#[derive(Serialize)]
struct EntryReport {
    input: PathBuf,
    output: PathBuf,
    /// `written`, `up_to_date` or `failed`.
    status: &'static str,
    error: Option<String>,
    bake: Option<BakeReport>,
}

impl DistributedJob {
    /// Reads a job and opens the journal in its folder.
    ///
    /// `options` are command-line options of `darboux bake`. Errors, one sentence each: what the command
    /// refuses; another run works on the job.
    pub fn open(job: &Path, options: &[String]) -> Result<Self, String> {
        let arguments = parsed(job, options)?;
        let entries = entries_of(&arguments)?;
        check_entries(&arguments, &entries)?;
        let run = new_run();
        let journal = Journal::open(&folder_of(&arguments), run)?;
        let task = |(number, entry): (usize, &Entry)| {
            let BakeArguments { low, output, .. } = &entry.arguments;
            let task = BakeTask {
                run: run.0,
                job: job.to_owned(),
                options: options.to_vec(),
                entry: number,
                entry_options: entry.options.clone(),
                low: low.clone(),
                output: output.clone(),
                record: journal.find(output).cloned(),
                may_have_written: journal.may_have_written(output) || may_write(&entry.arguments),
            };
            serde_json::to_string(&task).map_err(|_| format!("{}: the path is not UTF-8", low.display()))
        };
        let tasks = entries.iter().enumerate().map(task).collect::<Result<_, _>>()?;
        // A worker that is lost may leave its outputs without a record.
        for entry in entries.iter().filter(|entry| may_write(&entry.arguments)) {
            journal.plan(&entry.arguments.output)?;
        }
        Ok(Self { journal, tasks })
    }

    /// One task per entry, as JSON.
    pub fn tasks(&self) -> &[String] {
        &self.tasks
    }

    /// Adds the result of a task to the journal. Errors: the result was not made by
    /// [`run_task`](crate::run_task); the journal cannot be written.
    pub fn record(&self, result: &str) -> Result<(), String> {
        record(&self.journal, result)
    }

    /// Removes the temporary files of killed workers and unlocks the journal. No worker may be running.
    pub fn close(&self) -> Result<(), String> {
        self.journal.remove_temporary_files()?;
        self.journal.unlock()
    }
}

/// Bakes the entry of a task. The result of one that fails holds the reason. Errors: the result cannot be
/// JSON.
pub fn run_bake_task(task: BakeTask) -> Result<String, String> {
    let done = bake_task(&task);
    let BakeTask { low, output, .. } = task;
    let (status, error, BakedEntry { report, record }) = match done {
        Ok(baked) if baked.report.is_some() => ("written", None, baked),
        Ok(baked) => ("up_to_date", None, baked),
        Err(sentence) => ("failed", Some(sentence), BakedEntry { report: None, record: None }),
    };
    json(&TaskResult { report: EntryReport { input: low, output, status, error, bake: report }, record })
}

/// The result of a task that could not be run. Errors: as of [`run_bake_task`].
pub fn failed_bake_task(task: BakeTask, reason: &str) -> Result<String, String> {
    let BakeTask { low, output, .. } = task;
    let error = Some(format!("{}: {reason}", low.display()));
    let report = EntryReport { input: low, output, status: "failed", error, bake: None };
    json(&TaskResult { report, record: None })
}

fn bake_task(task: &BakeTask) -> Result<BakedEntry, String> {
    let arguments = parsed(&task.job, &task.options)?;
    let entries = entries_of(&arguments)?;
    let entry = entries.get(task.entry).filter(|entry| entry.options == task.entry_options);
    let entry = entry.ok_or_else(|| {
        format!("{}: was changed while its entries were baked; run it again", task.job.display())
    })?;
    let folder = folder_of(&arguments);
    let recorded =
        Recorded { folder: &folder, record: task.record.as_ref(), may_have_written: task.may_have_written };
    let of_entry = arguments_of(entry, Some(recorded))?;
    let run = RunId(task.run);
    let bake = || bake_entry(&of_entry, &entry.options, Some(recorded), run, None, &Messages::new(true));
    net::catch(&task.low.display(), || bake().map_err(String::from))
}

/// Whether none of an entry's outputs exists, so that what exists later may be the entry's.
fn may_write(arguments: &BakeArguments) -> bool {
    !has_place(&arguments.output) && all_outputs(arguments).iter().all(|output| !output.exists())
}

fn entries_of(arguments: &BakeArguments) -> Result<Vec<Entry>, String> {
    match work_of(arguments)? {
        Work::Job(job) => Ok(job.entries),
        Work::Single => Err(format!(
            "{}: is no job; name a TOML file, or a folder and --suffixes",
            arguments.low.display()
        )),
    }
}

/// Parses the command line. Errors: clap's message in one line.
fn parsed(job: &Path, options: &[String]) -> Result<BakeArguments, String> {
    let fixed = ["darboux", "bake", "--resume"].map(OsString::from);
    let options = options.iter().map(OsString::from);
    let all = fixed.into_iter().chain(options).chain(["--".into(), job.into()]);
    match Arguments::try_parse_from(all).map_err(|error| sentence_of(&error))?.command {
        Command::Bake(arguments) => Ok(*arguments),
        _ => Err("the command is not bake".into()),
    }
}

fn json(result: &TaskResult) -> Result<String, String> {
    serde_json::to_string(result).map_err(|error| error.to_string())
}

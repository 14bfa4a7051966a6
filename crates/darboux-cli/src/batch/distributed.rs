//! `darboux tangents FILES --out-dir FOLDER --resume` in steps, for programs that distribute the files to
//! their own workers.
//!
//! [`DistributedBatch::open`] makes one task per file. [`run_task`] processes a task and returns its result,
//! in any process on any machine that sees the same files. [`DistributedBatch::record`] adds the result to
//! the journal. Tasks, results and reports are JSON.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Parser;
use darboux_io::RunId;
use serde::{Deserialize, Serialize};

use super::command::FileCommand;
use super::journal::{Journal, Record};
use super::one_file::{JournalEntry, process_file, refuse_foreign};
use super::plan::{Job, Output, OutputRules, plan_jobs};
use super::report::FileReport;
use super::task_result::{TaskResult, record, sentence_of};
use crate::command_line::{Arguments, Command};
use crate::commands::tangents::arguments::TangentsArguments;
use crate::commands::tangents::summary::TangentsFileSummary;
use crate::inputs::{Input, SearchMode, find_inputs};
use crate::terminal::Messages;

/// An output folder with its locked journal, and one task per input file.
pub struct DistributedBatch {
    journal: Journal,
    tasks: Vec<String>,
    failed: Vec<String>,
}

/// The work on one file.
#[derive(Serialize, Deserialize)]
struct Task {
    run: u64,
    options: Vec<String>,
    folder: PathBuf,
    input: PathBuf,
    output: PathBuf,
    record: Option<Record>,
    /// Whether an earlier run may have written the output without leaving a record.
    may_have_written: bool,
}

/// A task of one of the commands that distribute their work.
#[derive(Deserialize)]
#[serde(untagged)]
enum AnyTask {
    Tangents(Task),
    #[cfg(feature = "bake")]
    Bake(crate::commands::bake::job::distributed::BakeTask),
}

impl DistributedBatch {
    /// Finds the models in files and folders, as the command does, and opens the journal of `folder`.
    ///
    /// `options` are command-line options of `darboux tangents`. A path that is not UTF-8 fails alone.
    /// Errors, one sentence each: the command line is refused; another run writes to the folder.
    pub fn open(inputs: &[PathBuf], folder: &Path, options: &[String]) -> Result<Self, String> {
        let arguments = parsed(inputs, folder, options)?;
        arguments.check().map_err(|usage| usage.0)?;
        let found = find_inputs(inputs, SearchMode::SkipOutputs { out_dir: Some(folder), in_place: false });
        let rules =
            OutputRules { suffix: arguments.suffix(), json: false, images: TangentsArguments::IMAGES };
        let jobs = plan_jobs(&arguments.files, rules, &found).map_err(|usage| usage.0)?;
        let run = arguments.files.run;
        let journal = Journal::open(folder, run)?;
        let task = |job: &Job| {
            let (Input::File(input), Output::File(output)) = (&job.input, &job.output) else { return None };
            let task = Task {
                run: run.0,
                options: options.to_vec(),
                folder: folder.to_owned(),
                input: input.clone(),
                output: output.clone(),
                record: journal.find(output).cloned(),
                may_have_written: journal.may_have_written(output) || !output.exists(),
            };
            // A path that is not UTF-8 is the only part of a task that JSON cannot hold.
            Some(
                serde_json::to_string(&task).map_err(|_| (input.clone(), "the path is not UTF-8".to_owned())),
            )
        };
        let (mut tasks, mut failed) = (Vec::new(), found.failed);
        for task in jobs.iter().filter_map(task) {
            match task {
                Ok(task) => tasks.push(task),
                Err(failure) => failed.push(failure),
            }
        }
        // A worker that is lost may leave its output without a record.
        for job in &jobs {
            if let Output::File(output) = &job.output
                && !output.exists()
            {
                journal.plan(output)?;
            }
        }
        let failed = failed.into_iter().map(FileReport::<TangentsFileSummary>::not_searched);
        let failed = failed.map(|report| json(&report)).collect::<Result<_, String>>()?;
        Ok(Self { journal, tasks, failed })
    }

    /// One task per file, as JSON.
    pub fn tasks(&self) -> &[String] {
        &self.tasks
    }

    /// The reports of paths that cannot be searched, and of files whose path is not UTF-8.
    pub fn failed(&self) -> &[String] {
        &self.failed
    }

    /// Adds the result of a task to the journal. Errors: the result was not made by [`run_task`]; the journal
    /// cannot be written.
    pub fn record(&self, result: &str) -> Result<(), String> {
        record(&self.journal, result)
    }

    /// Removes the temporary files of killed workers and unlocks the journal. No worker may be running.
    pub fn close(&self) -> Result<(), String> {
        self.journal.remove_temporary_files()?;
        self.journal.unlock()
    }
}

/// Processes the file of a task, or bakes the entry of a job. The result of a failed task holds the reason.
/// Errors: the task was made neither by [`DistributedBatch::open`] nor by a job.
pub fn run_task(task: &str) -> Result<String, String> {
    match parse_task(task)? {
        AnyTask::Tangents(task) => run_tangents_task(task),
        #[cfg(feature = "bake")]
        AnyTask::Bake(task) => crate::commands::bake::job::distributed::run_bake_task(task),
    }
}

/// The result of a task that could not be run, for example because its worker was lost at every attempt.
/// Errors: as [`run_task`].
pub fn failed_task(task: &str, reason: &str) -> Result<String, String> {
    match parse_task(task)? {
        AnyTask::Tangents(task) => failed_tangents_task(&task, reason),
        #[cfg(feature = "bake")]
        AnyTask::Bake(task) => crate::commands::bake::job::distributed::failed_bake_task(task, reason),
    }
}

fn run_tangents_task(task: Task) -> Result<String, String> {
    let Task { run, options, folder, input, output, record, may_have_written } = task;
    let mut arguments = parsed(std::slice::from_ref(&input), &folder, &options)?;
    arguments.files.run = RunId(run);
    let job = Job { input: Input::File(input), output: Output::File(output) };
    let entry = Some(JournalEntry { folder: &folder, record: record.as_ref(), may_have_written });
    if let Err(sentence) = refuse_foreign(&arguments, &job, entry) {
        return failed(job.input.to_string(), sentence);
    }
    let finished = process_file(&arguments, &job, entry, &Messages::new(true));
    json(&TaskResult { report: finished.report, record: finished.record })
}

fn failed_tangents_task(task: &Task, reason: &str) -> Result<String, String> {
    let input = task.input.display().to_string();
    let sentence = format!("{input}: {reason}");
    failed(input, sentence)
}

fn failed(input: String, sentence: String) -> Result<String, String> {
    json(&TaskResult { report: FileReport::<TangentsFileSummary>::failed(input, sentence), record: None })
}

fn parse_task(task: &str) -> Result<AnyTask, String> {
    serde_json::from_str(task).map_err(|error| format!("the task cannot be parsed: {error}"))
}

/// Parses the command line. Errors: clap's message in one line.
fn parsed(inputs: &[PathBuf], folder: &Path, options: &[String]) -> Result<TangentsArguments, String> {
    let fixed = ["darboux", "tangents", "--resume", "--out-dir"].map(OsString::from);
    let options = options.iter().map(OsString::from);
    let inputs = inputs.iter().map(OsString::from);
    let all = fixed.into_iter().chain([folder.into()]).chain(options).chain(["--".into()]).chain(inputs);
    match Arguments::try_parse_from(all).map_err(|error| sentence_of(&error))?.command {
        Command::Tangents(arguments) => Ok(arguments),
        _ => Err("the command is not tangents".into()),
    }
}

fn json(value: &impl Serialize) -> Result<String, String> {
    serde_json::to_string(value).map_err(|error| error.to_string())
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::ffi::OsStr;
    use std::fs;
    use std::os::unix::ffi::OsStrExt;

    use super::*;

    #[test]
    fn a_path_that_is_not_utf8_fails_alone() {
        let folder = tempfile::tempdir().unwrap();
        let models = folder.path().join("models");
        fs::create_dir(&models).unwrap();
        for name in [OsStr::new("good.glb"), OsStr::from_bytes(b"bad\xff.glb")] {
            fs::write(models.join(name), "").unwrap();
        }
        let batch = DistributedBatch::open(&[models], &folder.path().join("out"), &[]).unwrap();
        assert_eq!(batch.tasks().len(), 1);
        assert!(batch.tasks()[0].contains("good.glb"));
        assert_eq!(batch.failed().len(), 1);
        assert!(batch.failed()[0].contains("the path is not UTF-8"));
        batch.close().unwrap();
    }
}

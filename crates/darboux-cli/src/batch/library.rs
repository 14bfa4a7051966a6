//! `darboux tangents FILES --out-dir FOLDER --resume` in steps, for programs that distribute the files to their own workers.
//!
//! [`Library::open`] returns one order per file. [`carry_out`] turns an order into an answer, in any process on any machine that sees the
//! same files. [`Library::take`] adds the answer to the journal. Orders, answers and reports are JSON.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Parser;
use darboux_io::RunId;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use super::command::FileCommand;
use super::journal::{Journal, Record};
use super::one_file::{JournalEntry, process_file};
use super::plan::{Job, Output, OutputRules, plan_jobs};
use super::report::FileReport;
use crate::command_line::{Arguments, Command};
use crate::commands::tangents::arguments::TangentsArguments;
use crate::commands::tangents::summary::TangentsSummary;
use crate::inputs::{Input, SearchMode, find_inputs};
use crate::terminal::Messages;

/// An output folder with its locked journal, and one order per input file.
pub struct Library {
    journal: Journal,
    orders: Vec<String>,
    failed: Vec<String>,
}

/// The work on one file.
#[derive(Serialize, Deserialize)]
struct Order {
    run: u64,
    options: Vec<String>,
    folder: PathBuf,
    input: PathBuf,
    output: PathBuf,
    record: Option<Record>,
}

/// The result of an order. `R` is the type of the report.
#[derive(Serialize, Deserialize)]
struct Answer<R> {
    report: R,
    record: Option<Record>,
}

impl Library {
    /// Finds the models in files and folders, as the command does, and opens the journal of `folder`.
    ///
    /// `options` are command-line options of `darboux tangents`. A path that is not UTF-8 fails alone. Errors, one sentence each: the command
    /// line is refused; another run writes to the folder.
    pub fn open(inputs: &[PathBuf], folder: &Path, options: &[String]) -> Result<Self, String> {
        let arguments = parsed(inputs, folder, options)?;
        arguments.check().map_err(|usage| usage.0)?;
        let found = find_inputs(inputs, SearchMode::SkipOutputs { out_dir: Some(folder) });
        let rules =
            OutputRules { suffix: arguments.suffix(), json: false, images: TangentsArguments::IMAGES };
        let jobs = plan_jobs(&arguments.files, rules, &found).map_err(|usage| usage.0)?;
        let run = arguments.files.run;
        let journal = Journal::open(folder, run)?;
        let order = |job: &Job| {
            let (Input::File(input), Output::File(output)) = (&job.input, &job.output) else { return None };
            let order = Order {
                run: run.0,
                options: options.to_vec(),
                folder: folder.to_owned(),
                input: input.clone(),
                output: output.clone(),
                record: journal.find(output).cloned(),
            };
            // A path that is not UTF-8 is the only order that JSON cannot hold.
            Some(
                serde_json::to_string(&order)
                    .map_err(|_| (input.clone(), "the path is not UTF-8".to_owned())),
            )
        };
        let (mut orders, mut failed) = (Vec::new(), found.failed);
        for order in jobs.iter().filter_map(order) {
            match order {
                Ok(order) => orders.push(order),
                Err(failure) => failed.push(failure),
            }
        }
        let failed = failed.into_iter().map(FileReport::<TangentsSummary>::not_searched);
        let failed = failed.map(|report| json(&report)).collect::<Result<_, String>>()?;
        Ok(Self { journal, orders, failed })
    }

    /// One order per file, as JSON.
    pub fn orders(&self) -> &[String] {
        &self.orders
    }

    /// The reports of paths that cannot be searched, and of files whose path is not UTF-8.
    pub fn failed(&self) -> &[String] {
        &self.failed
    }

    /// Adds an answer to the journal. Errors: the answer was not made by [`carry_out`]; the journal cannot be written.
    pub fn take(&self, answer: &str) -> Result<(), String> {
        let answer: Answer<&RawValue> =
            serde_json::from_str(answer).map_err(|error| format!("the answer cannot be parsed: {error}"))?;
        answer.record.map_or(Ok(()), |record| self.journal.add(&record))
    }

    /// Removes the temporary files of killed workers and unlocks the journal. No worker may be running.
    pub fn close(&self) -> Result<(), String> {
        self.journal.remove_temporary_files()?;
        self.journal.unlock()
    }
}

/// Processes the file of an order; the answer also tells a failure. Errors: the order was not made by [`Library::open`].
pub fn carry_out(order: &str) -> Result<String, String> {
    let order: Order =
        serde_json::from_str(order).map_err(|error| format!("the order cannot be parsed: {error}"))?;
    let mut arguments = parsed(std::slice::from_ref(&order.input), &order.folder, &order.options)?;
    arguments.files.run = RunId(order.run);
    let job = Job { input: Input::File(order.input), output: Output::File(order.output) };
    let entry = JournalEntry { folder: &order.folder, record: order.record.as_ref() };
    let finished = process_file(&arguments, &job, Some(entry), &Messages::new(true));
    json(&Answer { report: finished.report, record: finished.record })
}

/// The answer to an order whose worker was lost at every attempt.
pub fn give_up(order: &str, reason: &str) -> Result<String, String> {
    let order: Order =
        serde_json::from_str(order).map_err(|error| format!("the order cannot be parsed: {error}"))?;
    let input = order.input.display().to_string();
    let sentence = format!("{input}: {reason}");
    json(&Answer { report: FileReport::<TangentsSummary>::failed(input, sentence), record: None })
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

/// The first paragraph of clap's message, without the usage hints.
fn sentence_of(error: &clap::Error) -> String {
    let text = error.to_string();
    let lines: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).map(str::trim).collect();
    lines.join(" ").trim_start_matches("error: ").to_owned()
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
        let library = Library::open(&[models], &folder.path().join("out"), &[]).unwrap();
        assert_eq!(library.orders().len(), 1);
        assert!(library.orders()[0].contains("good.glb"));
        assert_eq!(library.failed().len(), 1);
        assert!(library.failed()[0].contains("the path is not UTF-8"));
        library.close().unwrap();
    }
}

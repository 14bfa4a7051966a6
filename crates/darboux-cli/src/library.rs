//! `darboux tangents FILES --out-dir FOLDER --resume` in pieces, for programs that hand the files to workers of their own.
//!
//! [`Library::open`] gives an order per file, [`carry_out`] makes it an answer, in whatever process on whatever machine sees the same
//! files, and [`Library::take`] notes the answer. Orders, answers and reports are JSON.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Parser;
use darboux_io::RunId;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use crate::arguments::{Arguments, Command, TangentsArguments};
use crate::batch::{Known, Work, unsearched, work};
use crate::jobs::{self, Input, Job, Output, Rules, Scan};
use crate::journal::{Journal, Record};
use crate::messages::Messages;
use crate::report::FileReport;
use crate::tangents::TangentsSummary;

/// Models on their way into a folder of outputs, which nobody else writes to meanwhile.
pub struct Library {
    journal: Journal,
    orders: Vec<String>,
    failed: Vec<String>,
}

/// One file's work.
#[derive(Serialize, Deserialize)]
struct Order {
    run: u64,
    options: Vec<String>,
    folder: PathBuf,
    input: PathBuf,
    output: PathBuf,
    record: Option<Record>,
}

/// What became of it. `R` is its report.
#[derive(Serialize, Deserialize)]
struct Answer<R> {
    report: R,
    record: Option<Record>,
}

impl Library {
    /// Finds the models in files and folders, as the command does, and opens the journal of `folder`.
    ///
    /// `options` are those of the command. A file whose path is not UTF-8 fails alone. Errors, one sentence each: what the command refuses;
    /// another run that writes there.
    pub fn open(inputs: &[PathBuf], folder: &Path, options: &[String]) -> Result<Self, String> {
        let arguments = parsed(inputs, folder, options)?;
        arguments.check().map_err(|usage| usage.0)?;
        let found = jobs::find(inputs, Scan::Sources { out_dir: Some(folder) });
        let rules = Rules { word: arguments.word(), json: false, images: TangentsArguments::IMAGES };
        let jobs = jobs::plan(&arguments.files, rules, &found).map_err(|usage| usage.0)?;
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
            // JSON takes every order but one with such a path.
            Some(
                serde_json::to_string(&order)
                    .map_err(|_| (input.clone(), "the path is not UTF-8".to_owned())),
            )
        };
        let (mut orders, mut failed) = (Vec::new(), found.failed);
        for order in jobs.iter().filter_map(order) {
            match order {
                Ok(order) => orders.push(order),
                Err(unnamed) => failed.push(unnamed),
            }
        }
        let failed = failed.into_iter().map(unsearched::<TangentsSummary>);
        let failed = failed.map(|report| json(&report)).collect::<Result<_, String>>()?;
        Ok(Self { journal, orders, failed })
    }

    /// An order per file.
    pub fn orders(&self) -> &[String] {
        &self.orders
    }

    /// The reports of places that could not be searched, and of files that no order can name.
    pub fn failed(&self) -> &[String] {
        &self.failed
    }

    /// Notes what is done. Errors: an answer of nobody's; a journal that cannot be written.
    pub fn take(&self, answer: &str) -> Result<(), String> {
        let answer: Answer<&RawValue> =
            serde_json::from_str(answer).map_err(|error| format!("the answer is not one: {error}"))?;
        answer.record.map_or(Ok(()), |record| self.journal.add(&record))
    }

    /// Removes what killed workers left half-written, and lets other runs write there. No worker may be at work.
    pub fn close(&self) -> Result<(), String> {
        self.journal.remove_left()?;
        self.journal.unlock()
    }
}

/// Does what an order says; a file's failure is an answer too. Errors: an order of nobody's.
pub fn carry_out(order: &str) -> Result<String, String> {
    let order: Order =
        serde_json::from_str(order).map_err(|error| format!("the order is not one: {error}"))?;
    let mut arguments = parsed(std::slice::from_ref(&order.input), &order.folder, &order.options)?;
    arguments.files.run = RunId(order.run);
    let job = Job { input: Input::File(order.input), output: Output::File(order.output) };
    let known = Known { folder: &order.folder, record: order.record.as_ref() };
    let done = work(&arguments, &job, Some(known), &Messages::new(true));
    json(&Answer { report: done.report, record: done.record })
}

/// The answer to an order whose worker was lost, however often it was tried.
pub fn give_up(order: &str, reason: &str) -> Result<String, String> {
    let order: Order =
        serde_json::from_str(order).map_err(|error| format!("the order is not one: {error}"))?;
    let input = order.input.display().to_string();
    let sentence = format!("{input}: {reason}");
    json(&Answer { report: FileReport::<TangentsSummary>::failed(input, sentence), record: None })
}

/// The command's arguments. Errors: clap's, in one line.
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

/// What is wrong, without advice for a command line.
fn sentence_of(error: &clap::Error) -> String {
    let text = error.to_string();
    let told = text.lines().take_while(|line| !line.is_empty()).map(str::trim);
    let told: Vec<&str> = told.collect();
    told.join(" ").trim_start_matches("error: ").to_owned()
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

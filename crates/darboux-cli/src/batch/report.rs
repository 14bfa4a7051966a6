//! The JSON reports of the subcommands that write files. json.txt documents their fields, whose names are stable.

use std::path::PathBuf;

use serde::Serialize;
use serde_json::{Map, Value};

use crate::json::VERSION;

/// The report of a run.
#[derive(Serialize)]
pub struct BatchReport<S> {
    pub command: &'static str,
    pub version: &'static str,
    pub files: Vec<FileReport<S>>,
    pub totals: FileTotals,
}

/// The report of one file; `S` is the summary of the command.
#[derive(Serialize)]
pub struct FileReport<S> {
    pub input: String,
    pub output: Option<String>,
    pub status: Status,
    pub error: Option<String>,
    pub files_written: Vec<String>,
    #[serde(flatten)]
    pub summary: SummarySource<S>,
}

/// The summary of a file, from this run or from an earlier one.
#[derive(Serialize)]
#[serde(untagged)]
pub enum SummarySource<S> {
    /// This run processed the file.
    ThisRun(S),
    /// An earlier run processed the file; this is its summary from the journal.
    Journal(Map<String, Value>),
}

impl<S> SummarySource<S> {
    /// The summary of this run; `None` for a file that an earlier run processed.
    pub fn this_run(&self) -> Option<&S> {
        match self {
            Self::ThisRun(summary) => Some(summary),
            Self::Journal(_) => None,
        }
    }
}

/// The outcome of a file.
#[derive(Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The output differs from the input.
    Written,
    /// The output is a copy: nothing had to change.
    Copied,
    /// The file was not touched by --in-place: nothing had to change.
    Untouched,
    /// The output of an earlier run is up to date.
    UpToDate,
    /// No output was written.
    Failed,
}

/// The number of files by outcome.
#[derive(Default, Serialize)]
pub struct FileTotals {
    pub files: usize,
    pub written: usize,
    pub copied: usize,
    pub untouched: usize,
    pub up_to_date: usize,
    pub failed: usize,
}

impl<S: Default> FileReport<S> {
    /// The report of a file without output.
    pub fn failed(input: String, error: String) -> Self {
        Self {
            input,
            output: None,
            status: Status::Failed,
            error: Some(error),
            files_written: Vec::new(),
            summary: SummarySource::ThisRun(S::default()),
        }
    }

    /// The report of a path that cannot be searched.
    pub fn not_searched((path, reason): (PathBuf, String)) -> Self {
        let path = path.display().to_string();
        let sentence = format!("{path}: {reason}");
        Self::failed(path, sentence)
    }
}

impl<S> BatchReport<S> {
    /// The report of these files.
    pub fn new(command: &'static str, files: Vec<FileReport<S>>) -> Self {
        let mut totals = FileTotals { files: files.len(), ..FileTotals::default() };
        for file in &files {
            *match file.status {
                Status::Written => &mut totals.written,
                Status::Copied => &mut totals.copied,
                Status::Untouched => &mut totals.untouched,
                Status::UpToDate => &mut totals.up_to_date,
                Status::Failed => &mut totals.failed,
            } += 1;
        }
        Self { command, version: VERSION, files, totals }
    }
}

//! The interface of the subcommands that write one output file for each input file.

use std::path::Path;

use serde::Serialize;
use serde_json::{Map, Value};

use super::plan::Job;
use super::report::{FileReport, Status, SummarySource};
use crate::inputs::UsageError;
use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;
use crate::terminal::FileProgress;

/// A subcommand that processes files one by one.
pub trait FileCommand: Sync {
    /// The part of a file's report that only this command has.
    type Summary: Default + Send + Serialize;
    /// What the command counts over the files of a run.
    type Totals: Default;

    /// The name of the subcommand.
    const NAME: &'static str;
    /// Whether the command accepts images as well as models.
    const IMAGES: bool;

    /// The suffix of output names: model.glb becomes model.SUFFIX.glb.
    fn suffix(&self) -> &str;

    /// The input and output arguments.
    fn files(&self) -> &FileOptions;

    /// The arguments about messages.
    fn messages(&self) -> &MessageOptions;

    /// Refuses arguments that contradict each other.
    fn check(&self) -> Result<(), UsageError> {
        Ok(())
    }

    /// The options that affect outputs, as text; the journal compares these texts.
    fn options(&self) -> String;

    /// A file that all outputs depend on, in addition to their inputs.
    fn common_input(&self) -> Option<&Path> {
        None
    }

    /// Whether the command accepts an output that exists if it would write the same.
    fn compares_existing(&self) -> bool {
        false
    }

    /// Reads, changes and writes a file. Errors are one sentence each.
    fn process(&self, job: &Job, progress: &FileProgress<'_>)
    -> Result<ProcessedFile<Self::Summary>, String>;

    /// Whether what was found in a file, in this run or in an earlier one, makes the exit code 1.
    fn fails(&self, _summary: &SummarySource<Self::Summary>) -> bool {
        false
    }

    /// What a run says of a file that an earlier run processed, in addition; `recorded` is the summary of
    /// that run.
    fn note_up_to_date(_recorded: &Map<String, Value>) -> Option<String> {
        None
    }

    /// What was done to each part of a file, one line each.
    fn lines(summary: &Self::Summary) -> Vec<String>;

    /// What is still wrong with a file, one line each; printed with `--quiet`, where [`FileCommand::lines`]
    /// are not.
    fn errors(_summary: &Self::Summary) -> Vec<String> {
        Vec::new()
    }

    /// The warnings of a file, one sentence each.
    fn warnings(summary: &Self::Summary) -> &[String];

    /// Adds a file to the totals of a run.
    fn count(totals: &mut Self::Totals, file: &FileReport<Self::Summary>);

    /// The totals of a run in words.
    fn total(totals: &Self::Totals) -> String;
}

/// The result of processing one file.
pub struct ProcessedFile<S> {
    pub status: Status,
    pub files_written: Vec<String>,
    pub summary: S,
}

//! Processes one file and returns its report; a panic fails this file alone.

use std::path::Path;

use super::command::{FileCommand, ProcessedFile};
use super::journal::{Journal, OutputInputs, Record};
use super::plan::{Job, Output};
use super::report::{FileReport, Status, SummarySource};
use crate::inputs::Input;
use crate::net;
use crate::terminal::{FileProgress, Messages};

/// What a journal says about one output.
#[derive(Clone, Copy)]
pub struct JournalEntry<'a> {
    pub folder: &'a Path,
    /// `None` for an output that the journal does not list.
    pub record: Option<&'a Record>,
    /// Whether an earlier run may have written the output without leaving a record.
    pub may_have_written: bool,
}

impl<'a> JournalEntry<'a> {
    /// The entry of a job.
    pub fn new(journal: &'a Journal, job: &Job) -> Self {
        let (record, may_have_written) = match &job.output {
            Output::File(output) => (journal.find(output), journal.may_have_written(output)),
            Output::Stdout => (None, false),
        };
        Self { folder: journal.folder(), record, may_have_written }
    }
}

/// The report of a file, and the record to add to the journal.
pub struct FinishedFile<S> {
    pub report: FileReport<S>,
    /// `None` without a journal and for files that did not change.
    pub record: Option<Record>,
}

/// Processes a file. `entry` is `None` for runs without a journal.
pub fn process_file<W: FileCommand>(
    command: &W,
    job: &Job,
    entry: Option<JournalEntry<'_>>,
    messages: &Messages,
) -> FinishedFile<W::Summary> {
    let progress = messages.file(&job.input.to_string(), job.input.byte_length());
    let finished = net::catch(&job.input, || match (entry, &job.input, &job.output) {
        (Some(entry), Input::File(input), Output::File(output)) => {
            resume(command, job, entry, (input, output), &progress)
        }
        _ => refuse_existing(&job.output, command)
            .and_then(|()| command.process(job, &progress))
            .map(|processed| FinishedFile { report: report_of(job, processed), record: None }),
    });
    finished.unwrap_or_else(|sentence| FinishedFile {
        report: FileReport::failed(job.input.to_string(), sentence),
        record: None,
    })
}

/// Processes a file unless its output is up to date.
fn resume<W: FileCommand>(
    command: &W,
    job: &Job,
    JournalEntry { folder, record, .. }: JournalEntry<'_>,
    (input, output): (&Path, &Path),
    progress: &FileProgress<'_>,
) -> Result<FinishedFile<W::Summary>, String> {
    // Hash the input first: if it changes during the work, the next run sees another hash.
    let reading = &command.files().reading;
    let inputs = OutputInputs::new(W::NAME, command.options(), input, reading)?
        .with_common_input(command.common_input(), reading)?;
    if let Some(record) = record.filter(|record| record.is_up_to_date(&inputs, folder)) {
        let report = FileReport {
            input: job.input.to_string(),
            output: Some(job.output.to_string()),
            status: Status::UpToDate,
            error: None,
            files_written: Vec::new(),
            summary: SummarySource::Journal(record.summary.clone()),
        };
        return Ok(FinishedFile { report, record: None });
    }
    let processed = command.process(job, progress)?;
    let record = Record::new(folder, output, inputs, &processed.files_written, &processed.summary)?;
    Ok(FinishedFile { report: report_of(job, processed), record })
}

/// Refuses an output that exists although no run has written it. `entry` is `None` for runs without a
/// journal.
pub fn refuse_foreign(
    command: &impl FileCommand,
    job: &Job,
    entry: Option<JournalEntry<'_>>,
) -> Result<(), String> {
    let is_own = entry.is_none_or(|entry| entry.record.is_some() || entry.may_have_written);
    match &job.output {
        Output::File(path)
            if path.exists() && !is_own && !command.files().force && !command.compares_existing() =>
        {
            Err(foreign(path))
        }
        _ => Ok(()),
    }
}

/// Why `--resume` does not replace a file.
pub fn foreign(path: &Path) -> String {
    format!(
        "{}: exists, and the journal of --resume does not list it (runs without --resume keep none); use \
         --force to replace it, or move it away",
        path.display()
    )
}

fn report_of<S>(job: &Job, processed: ProcessedFile<S>) -> FileReport<S> {
    FileReport {
        input: job.input.to_string(),
        output: Some(job.output.to_string()),
        status: processed.status,
        error: None,
        files_written: processed.files_written,
        summary: SummarySource::ThisRun(processed.summary),
    }
}

/// Refuses an output that exists, before any work, unless the command compares it.
fn refuse_existing(output: &Output, command: &impl FileCommand) -> Result<(), String> {
    let may_exist = command.files().may_replace() || command.compares_existing();
    match output {
        Output::File(path) if path.exists() && !may_exist => {
            Err(format!("{output}: exists; use --force to replace it, or name another output"))
        }
        _ => Ok(()),
    }
}

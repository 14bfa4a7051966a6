//! What is kept of the files of a run: counts, the sentences that are printed at its end, and with `--json`
//! the report, which is written while the run goes on.

use std::time::Instant;

use darboux_io::system_reason;

use super::command::FileCommand;
use super::report::{FileReport, ReportStream};
use crate::exit;
use crate::terminal::Messages;
use crate::text::{counted, nonzero_counts};

pub struct Tally<'a, W: FileCommand> {
    command: &'a W,
    /// Whether each file is printed in one line.
    pub brief: bool,
    report: ReportStream,
    totals: W::Totals,
    /// Why files failed.
    errors: Vec<String>,
    /// What is wrong with files, with `--quiet`.
    remaining: Vec<String>,
    warnings: usize,
    has_failed: bool,
}

impl<'a, W: FileCommand> Tally<'a, W> {
    pub fn new(command: &'a W, brief: bool) -> Self {
        Self {
            command,
            brief,
            report: ReportStream::begin(W::NAME, command.messages().json),
            totals: W::Totals::default(),
            errors: Vec::new(),
            remaining: Vec::new(),
            warnings: 0,
            has_failed: false,
        }
    }

    /// Counts a file, and writes its part of the report.
    pub fn add(&mut self, file: &FileReport<W::Summary>) {
        self.report.add(file);
        W::count(&mut self.totals, file);
        self.errors.extend(file.error.clone());
        if let Some(summary) = file.summary.this_run() {
            self.warnings += W::warnings(summary).len();
            if self.command.messages().quiet {
                let errors = W::errors(summary);
                self.remaining.extend(errors.iter().map(|error| format!("{}: {error}", file.input)));
            }
        }
        self.has_failed |= file.error.is_some() || self.command.fails(&file.summary);
    }

    /// Prints errors, the totals and the end of the report; returns the exit code. `processed`: why the run
    /// ended early.
    pub fn finish(self, processed: Result<(), String>, messages: &Messages, start: Instant) -> u8 {
        self.errors.iter().chain(&self.remaining).for_each(|error| messages.error(error));
        let totals = self.report.totals();
        if processed.is_ok() && (totals.failed < totals.files || totals.files > 1) {
            let done = counted(totals.files - totals.failed - totals.up_to_date, "file", "files");
            let others = nonzero_counts([
                (totals.up_to_date, "file was up to date", "files were up to date"),
                (totals.failed, "file failed", "files failed"),
            ]);
            let seconds = start.elapsed().as_secs_f32();
            let total = W::total(&self.totals);
            messages.summary(&format!("{total} in {done}{others}; {seconds:.2} s{}", self.hidden_warnings()));
        }
        let written = self.report.end();
        if let Err(error) = &written {
            messages.error(&format!("the report cannot be written: {}", system_reason(error)));
        }
        if let Err(sentence) = &processed {
            messages.error(sentence);
        }
        if self.has_failed || written.is_err() || processed.is_err() { exit::FAILED } else { exit::DONE }
    }

    /// The number of warnings that were not printed.
    fn hidden_warnings(&self) -> String {
        if self.warnings == 0 || !(self.brief || self.command.messages().quiet) {
            return String::new();
        }
        format!("; {}, which --verbose prints", counted(self.warnings, "warning", "warnings"))
    }
}

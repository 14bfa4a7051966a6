//! The JSON reports of the subcommands that write files. json.txt documents their fields, whose names are
//! stable.

use std::io;
use std::path::PathBuf;

use serde::Serialize;
use serde_json::{Map, Value};

use crate::json::VERSION;
use crate::terminal::write_stdout;

/// The report of a run, which is written to standard output file by file, so that it takes no memory.
pub struct ReportStream {
    totals: FileTotals,
    /// Whether anything was refused; `None` without `--json`.
    written: Option<io::Result<()>>,
}

impl ReportStream {
    /// Begins the report of a command. Without `json`, files are only counted.
    pub fn begin(command: &str, json: bool) -> Self {
        let mut report = Self { totals: FileTotals::default(), written: json.then_some(Ok(())) };
        let [command, version] = [command, VERSION].map(Value::from);
        report.write(|| {
            Ok(format!("{{\n  \"command\": {command},\n  \"version\": {version},\n  \"files\": ["))
        });
        report
    }

    /// Counts a file, and writes its report.
    pub fn add(&mut self, file: &FileReport<impl Serialize>) {
        let separator = if self.totals.files == 0 { "\n    " } else { ",\n    " };
        self.totals.add(file.status);
        self.write(|| Ok(format!("{separator}{}", indented(file, 4)?)));
    }

    /// The number of files so far.
    pub fn totals(&self) -> &FileTotals {
        &self.totals
    }

    /// Ends the report. Errors: a part could not be written.
    pub fn end(mut self) -> io::Result<()> {
        let end_of_files = if self.totals.files == 0 { "]" } else { "\n  ]" };
        let totals = indented(&self.totals, 2);
        self.write(|| Ok(format!("{end_of_files},\n  \"totals\": {}\n}}\n", totals?)));
        self.written.unwrap_or(Ok(()))
    }

    /// Writes a text, unless an earlier one was refused.
    fn write(&mut self, text: impl FnOnce() -> io::Result<String>) {
        if let Some(written @ Ok(())) = &mut self.written {
            *written = text().and_then(|text| write_stdout(text.as_bytes()));
        }
    }
}

/// JSON in lines, all but the first of which begin with this many spaces more. Texts in JSON have no line
/// breaks.
fn indented(value: &impl Serialize, spaces: usize) -> io::Result<String> {
    Ok(serde_json::to_string_pretty(value)?.replace('\n', &format!("\n{}", " ".repeat(spaces))))
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

impl FileTotals {
    fn add(&mut self, status: Status) {
        self.files += 1;
        *match status {
            Status::Written => &mut self.written,
            Status::Copied => &mut self.copied,
            Status::Untouched => &mut self.untouched,
            Status::UpToDate => &mut self.up_to_date,
            Status::Failed => &mut self.failed,
        } += 1;
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn parts_of_a_report_are_indented_as_in_the_whole() {
        let file = json!({ "input": "a\nb", "primitives": [{ "name": "x" }] });
        let whole = serde_json::to_string_pretty(&json!({ "files": [file, file] })).unwrap();
        let part = indented(&file, 4).unwrap();
        assert_eq!(whole, format!("{{\n  \"files\": [\n    {part},\n    {part}\n  ]\n}}"));
    }
}

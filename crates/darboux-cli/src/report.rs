//! The JSON reports: stable names, described in json.md.

use darboux_io::gltf::PrimitiveInfo;
use serde::Serialize;
use serde_json::{Map, Value};

/// What commands that write files print with `--json`.
#[derive(Serialize)]
pub struct Report<S> {
    pub command: &'static str,
    pub version: &'static str,
    pub files: Vec<FileReport<S>>,
    pub totals: FileTotals,
}

/// What happened to one file; `S` is what the command has to say of it.
#[derive(Serialize)]
pub struct FileReport<S> {
    pub input: String,
    pub output: Option<String>,
    pub status: Status,
    pub error: Option<String>,
    pub files_written: Vec<String>,
    #[serde(flatten)]
    pub summary: Told<S>,
}

/// What the command has to say of a file.
#[derive(Serialize)]
#[serde(untagged)]
pub enum Told<S> {
    /// It was worked on now.
    Now(S),
    /// An earlier run did, and said this.
    Before(Map<String, Value>),
}

impl<S> Told<S> {
    /// What was done now.
    pub fn now(&self) -> Option<&S> {
        match self {
            Self::Now(summary) => Some(summary),
            Self::Before(_) => None,
        }
    }
}

/// A file's end.
#[derive(Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The output differs.
    Written,
    /// Nothing to do: the output is a copy.
    Copied,
    /// Nothing to do in place: the file is as it was.
    Untouched,
    /// An earlier run made the output; it is as it was.
    UpToDate,
    /// No output.
    Failed,
}

/// How many files met which end.
#[derive(Default, Serialize)]
pub struct FileTotals {
    pub files: usize,
    pub written: usize,
    pub copied: usize,
    pub untouched: usize,
    pub up_to_date: usize,
    pub failed: usize,
}

/// What `darboux inspect --json` prints.
#[derive(Serialize)]
pub struct InspectReport {
    pub command: &'static str,
    pub version: &'static str,
    pub files: Vec<InspectedFile>,
}

/// What one file holds.
#[derive(Clone, Serialize)]
pub struct InspectedFile {
    pub input: String,
    pub error: Option<String>,
    pub warnings: Vec<String>,
    pub primitives: Vec<PrimitiveInfo>,
}

/// The version in reports.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

impl<S: Default> FileReport<S> {
    /// The report of a file without output.
    pub fn failed(input: String, error: String) -> Self {
        Self {
            input,
            output: None,
            status: Status::Failed,
            error: Some(error),
            files_written: Vec::new(),
            summary: Told::Now(S::default()),
        }
    }
}

impl<S> Report<S> {
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

/// A report as text for standard output.
pub fn to_json(report: &impl Serialize) -> Result<Vec<u8>, serde_json::Error> {
    let mut text = serde_json::to_vec_pretty(report)?;
    text.push(b'\n');
    Ok(text)
}

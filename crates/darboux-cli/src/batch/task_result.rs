//! [`TaskResult`]: what a worker returns of a task.

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use super::journal::{Journal, Record};

/// The result of a task. `R` is the type of the report.
#[derive(Serialize, Deserialize)]
pub struct TaskResult<R> {
    pub report: R,
    pub record: Option<Record>,
}

/// Adds the result of a task to a journal. Errors: it is no result; the journal cannot be written.
pub fn record(journal: &Journal, result: &str) -> Result<(), String> {
    // The report stays text.
    let result: TaskResult<&RawValue> =
        serde_json::from_str(result).map_err(|error| format!("the result cannot be parsed: {error}"))?;
    result.record.map_or(Ok(()), |record| journal.add(&record))
}

/// The first paragraph of clap's message, without the usage hints.
pub fn sentence_of(error: &clap::Error) -> String {
    let text = error.to_string();
    let lines: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).map(str::trim).collect();
    lines.join(" ").trim_start_matches("error: ").to_owned()
}

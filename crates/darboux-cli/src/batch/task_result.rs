//! [`TaskResult`]: what a worker returns of a task.

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use super::journal::Record;

/// The result of a task whose report stays as it is.
pub type Unread<'a> = TaskResult<&'a RawValue>;

/// The result of a task. `R` is the type of the report.
#[derive(Serialize, Deserialize)]
pub struct TaskResult<R> {
    pub report: R,
    pub record: Option<Record>,
}

/// The first paragraph of clap's message, without the usage hints.
pub fn sentence_of(error: &clap::Error) -> String {
    let text = error.to_string();
    let lines: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).map(str::trim).collect();
    lines.join(" ").trim_start_matches("error: ").to_owned()
}

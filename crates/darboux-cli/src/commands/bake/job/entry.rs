//! A job: its bakes.

use crate::commands::bake::arguments::BakeArguments;

/// A pair of a job.
pub struct Entry {
    pub arguments: BakeArguments,
    /// Its options as text: what decides, besides the files, whether it is baked again.
    pub options: String,
    /// Where the job has it; none in a folder of pairs.
    pub place: Option<String>,
}
/// The bakes of a job, and what is unusual about it.
pub struct Job {
    pub entries: Vec<Entry>,
    pub warnings: Vec<String>,
}

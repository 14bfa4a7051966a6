//! A bake of a job.

use crate::commands::bake::arguments::BakeArguments;

/// A pair of a job.
pub struct Entry {
    pub arguments: BakeArguments,
    /// Its options as text: what decides, besides the files, whether it is baked again.
    pub options: String,
    /// Where the job has it; none in a folder of pairs.
    pub place: Option<String>,
}

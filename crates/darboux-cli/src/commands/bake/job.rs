//! A bake as a job: pairs of models with their settings, in a TOML file or found in a folder by their names.
//!
//! ```text
//! file        entries of a TOML file; every option of the command is a key
//! suffixes    pairs NAME_low, NAME_high, NAME_cage in a folder
//! run         bakes what has changed since an earlier run, several entries at once
//! distributed the same in steps, for workers of other programs
//! ```

pub mod distributed;
mod entry;
mod file;
mod run;
mod suffixes;

use super::arguments::BakeArguments;
use entry::Entry;

pub use run::run;

/// What LOW stands for.
pub enum Work {
    /// One low model.
    Single,
    Job(Vec<Entry>),
}

/// The entries of a job, if LOW is a TOML file or a folder. Errors are one sentence each.
pub fn work_of(arguments: &BakeArguments) -> Result<Work, String> {
    let low = &arguments.low;
    let is_toml = low.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    let is_job = is_toml || low.is_dir();
    if !is_job && arguments.resume {
        return Err("--resume belongs to jobs: LOW is a TOML file, or a folder with --suffixes".to_owned());
    }
    match (is_toml, low.is_dir(), arguments.suffixes) {
        (_, true, true) => suffixes::entries(arguments).map(Work::Job),
        (_, true, false) => Err(format!(
            "{}: is a folder; add --suffixes to bake the pairs NAME_low and NAME_high in it",
            low.display()
        )),
        (_, false, true) => Err(format!("{}: is no folder; --suffixes needs one", low.display())),
        (true, ..) => file::entries(low).map(Work::Job),
        _ => Ok(Work::Single),
    }
}

//! A bake as a job: pairs of models with their settings, in a TOML file or found in a folder by their names.
//!
//! ```text
//! file        entries of a TOML file; every option of the command is a key
//! keys        these options, by clap's own list
//! suffixes    pairs NAME_low, NAME_high, NAME_cage in a folder
//! run         bakes what has changed since an earlier run, several entries at once
//! distributed the same in steps, for workers of other programs
//! ```

pub mod distributed;
mod entry;
mod file;
mod keys;
mod run;
mod suffixes;

use std::path::Path;

use super::arguments::BakeArguments;
use entry::{Entry, Job};
use keys::Keys;
use suffixes::Pairs;

pub use run::run;

/// What LOW stands for.
pub enum Work {
    /// One low model.
    Single,
    Job(Job),
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
        (_, true, true) => {
            let Pairs { entries, warnings } = suffixes::pairs(arguments)?;
            Ok(Work::Job(Job { entries, warnings }))
        }
        (_, true, false) => Err(format!(
            "{}: is a folder; add --suffixes to bake the pairs NAME_low and NAME_high in it",
            low.display()
        )),
        (_, false, true) => Err(format!("{}: is no folder; --suffixes needs one", low.display())),
        (true, ..) => of_file(low, arguments).map(Work::Job),
        _ => Ok(Work::Single),
    }
}

/// The entries of a job file with the limits of the command line.
fn of_file(path: &Path, job: &BakeArguments) -> Result<Job, String> {
    let misplaced = Keys::new().misplaced(job);
    if !misplaced.is_empty() {
        let options: Vec<String> = misplaced.iter().map(|name| format!("--{name}")).collect();
        return Err(format!(
            "{}: sets the options of its bakes itself, so {} beside it would be without effect; write {} \
             into its [defaults]",
            path.display(),
            options.join(", "),
            misplaced.join(", ")
        ));
    }
    let mut entries = file::entries(path)?;
    let limits: String = [
        job.reading.memory_limit.map(|limit| format!("\u{1f}--memory-limit={limit:?}")),
        job.reading.allow_outside.then(|| "\u{1f}--allow-outside".to_owned()),
    ]
    .into_iter()
    .flatten()
    .collect();
    for Entry { arguments, options, .. } in &mut entries {
        arguments.makes_folders = true;
        arguments.jobs = job.jobs.or(arguments.jobs);
        arguments.reading.memory_limit = job.reading.memory_limit.or(arguments.reading.memory_limit);
        arguments.reading.allow_outside |= job.reading.allow_outside;
        arguments.force |= job.force;
        // A texture that was left out for them may be read now.
        *options += &limits;
    }
    Ok(Job { entries, warnings: Vec::new() })
}

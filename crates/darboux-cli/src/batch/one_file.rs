//! The work on one file, up to its report.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::{Made, Work, size_of};
use crate::arguments::Files;
use crate::jobs::{Input, Job, Output};
use crate::journal::{Origin, Record};
use crate::messages::{FileProgress, Messages};
use crate::report::{FileReport, Status, Told};

/// What a journal knows of an output.
#[derive(Clone, Copy)]
pub struct Known<'a> {
    /// The journal's folder.
    pub folder: &'a Path,
    pub record: Option<&'a Record>,
}

/// A file that is done, or that failed.
pub struct Done<S> {
    pub report: FileReport<S>,
    /// What is new to the journal, if there is one.
    pub record: Option<Record>,
}

/// Works on a file; a panic fails this file alone. `known`: none where no journal is kept.
pub fn work<W: Work>(
    command: &W,
    job: &Job,
    known: Option<Known<'_>>,
    messages: &Messages,
) -> Done<W::Summary> {
    let progress = messages.file(&job.input.to_string(), size_of(&job.input));
    let done = caught(&job.input, || match (known, &job.input, &job.output) {
        (Some(known), Input::File(input), Output::File(output)) => {
            resumed(command, job, known, (input, output), &progress)
        }
        _ => refuse_existing(&job.output, command.files())
            .and_then(|()| command.process(job, &progress))
            .map(|made| Done { report: told(job, made), record: None }),
    });
    done.unwrap_or_else(|sentence| Done {
        report: FileReport::failed(job.input.to_string(), sentence),
        record: None,
    })
}

/// What `work` gives, or one sentence for its panic. Nothing that it changed is looked at afterwards but whole files.
fn caught<T>(input: &Input, work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let told =
            panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        let reason = told.and_then(|told| told.lines().next()).unwrap_or("no reason given");
        Err(format!("{input}: the work on it broke off: {reason}; this is a defect of darboux"))
    })
}

/// Works on a file unless its output is up to date.
fn resumed<W: Work>(
    command: &W,
    job: &Job,
    Known { folder, record }: Known<'_>,
    (input, output): (&Path, &Path),
    progress: &FileProgress<'_>,
) -> Result<Done<W::Summary>, String> {
    // Before the work: an input that changes meanwhile has another content next time.
    let origin = Origin::new(W::COMMAND, command.options(), input, command.files().allow_outside)?;
    if let Some(record) = record.filter(|record| record.is_of(&origin, folder)) {
        let report = FileReport {
            input: job.input.to_string(),
            output: Some(job.output.to_string()),
            status: Status::UpToDate,
            error: None,
            files_written: Vec::new(),
            summary: Told::Before(record.summary.clone()),
        };
        return Ok(Done { report, record: None });
    }
    let made = command.process(job, progress)?;
    let record = Record::new(folder, output, origin, &made.files_written, &made.summary)?;
    Ok(Done { report: told(job, made), record })
}

fn told<S>(job: &Job, made: Made<S>) -> FileReport<S> {
    FileReport {
        input: job.input.to_string(),
        output: Some(job.output.to_string()),
        status: made.status,
        error: None,
        files_written: made.files_written,
        summary: Told::Now(made.summary),
    }
}

/// Says before any work that an output is in the way.
fn refuse_existing(output: &Output, files: &Files) -> Result<(), String> {
    match output {
        Output::File(path) if path.exists() && !files.replace() => {
            Err(format!("{output}: exists; use --force to replace it, or name another output"))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_one_sentence() {
        let sentence = "a.glb: the work on it broke off: burnt; this is a defect of darboux";
        let input = Input::File("a.glb".into());
        assert_eq!(caught::<()>(&input, || panic!("burnt\nto the ground")), Err(sentence.into()));
        assert_eq!(caught(&input, || Ok(3)), Ok(3));
    }
}

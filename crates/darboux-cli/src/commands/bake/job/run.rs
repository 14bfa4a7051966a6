//! Bakes the entries of a job.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::entry::Entry;
use crate::batch::journal::{Journal, OutputInputs, Record};
use crate::commands::bake::arguments::BakeArguments;
use crate::commands::bake::outputs::all_outputs;
use crate::commands::bake::report::{BakeReport, summary};
use crate::commands::bake::single::{bake_files, check_usage};
use crate::exit;
use crate::json::{VERSION, print_report};
use crate::options::files::new_run;
use crate::terminal::Messages;
use crate::text::counted;

/// The JSON report of a job. json.txt documents its fields.
#[derive(Debug, Serialize)]
struct JobReport {
    command: &'static str,
    version: &'static str,
    bakes: Vec<BakeReport>,
    up_to_date: usize,
    errors: Vec<String>,
}

/// Bakes the entries one after the other, each on all threads, and returns the exit code. An entry that fails does not stop the others.
pub fn run(arguments: &BakeArguments, entries: Vec<Entry>, messages: &Messages) -> u8 {
    if let Err(sentence) = check_entries(arguments, &entries) {
        messages.error(&sentence);
        return exit::USAGE;
    }
    print_entries(&entries, messages);
    let folder = match arguments.low.is_dir() {
        true => arguments.low.clone(),
        false => arguments
            .low
            .parent()
            .map(Path::to_owned)
            .filter(|folder| !folder.as_os_str().is_empty())
            .unwrap_or_else(|| ".".into()),
    };
    let journal = match arguments.resume.then(|| Journal::open(&folder, new_run())).transpose() {
        Ok(journal) => journal,
        Err(sentence) => {
            messages.error(&sentence);
            return exit::FAILED;
        }
    };
    let mut report =
        JobReport { command: "bake", version: VERSION, bakes: Vec::new(), up_to_date: 0, errors: Vec::new() };
    for entry in entries {
        match bake_entry(arguments, entry, journal.as_ref(), messages) {
            Ok(Some(baked)) => report.bakes.push(baked),
            Ok(None) => report.up_to_date += 1,
            Err(sentence) => {
                messages.error(&sentence);
                report.errors.push(sentence);
            }
        }
    }
    messages.say(&totals(&report));
    let code = print_report(&report, arguments.messages.json, messages);
    if report.errors.is_empty() { code } else { exit::FAILED }
}

/// Refuses, before anything is baked, entries that cannot be right, and files that two of them would write.
fn check_entries(job: &BakeArguments, entries: &[Entry]) -> Result<(), String> {
    let mut outputs: HashSet<PathBuf> = HashSet::new();
    for Entry { arguments, .. } in entries {
        let mut checked = arguments.clone();
        checked.force |= job.force || job.resume;
        check_usage(&checked)?;
        for output in all_outputs(arguments) {
            if outputs.contains(&output) {
                return Err(format!(
                    "{}: is written by two bakes of the job; choose another name",
                    output.display()
                ));
            }
            outputs.insert(output);
        }
    }
    Ok(())
}

fn print_entries(entries: &[Entry], messages: &Messages) {
    for Entry { arguments, .. } in entries {
        let BakeArguments { low, high, cage, output, .. } = arguments;
        let high: Vec<String> = high.iter().map(|path| path.display().to_string()).collect();
        let cage = cage.as_ref().map(|cage| format!(", cage {}", cage.display())).unwrap_or_default();
        messages.say(&format!("{} from {}{cage}: {}", low.display(), high.join(", "), output.display()));
    }
}

/// Bakes an entry; none if an earlier run has done it. Errors are one sentence each.
fn bake_entry(
    job: &BakeArguments,
    entry: Entry,
    journal: Option<&Journal>,
    messages: &Messages,
) -> Result<Option<BakeReport>, String> {
    let Entry { mut arguments, options } = entry;
    arguments.force |= job.force;
    arguments.jobs = arguments.jobs.or(job.jobs);
    let Some(journal) = journal else { return finish(&arguments, messages).map(Some) };
    let inputs = inputs_of(&arguments, options)?;
    let output = arguments.output.clone();
    if let Some(record) = journal.find(&output) {
        if record.is_up_to_date(&inputs, journal.folder()) {
            return Ok(None);
        }
        arguments.force = true;
    }
    let report = finish(&arguments, messages)?;
    if let Some(record) = Record::new(journal.folder(), &output, inputs, &report.files(), &report)? {
        journal.add(&record)?;
    }
    Ok(Some(report))
}

fn finish(arguments: &BakeArguments, messages: &Messages) -> Result<BakeReport, String> {
    let report = bake_files(arguments, messages)?;
    report.warnings.iter().for_each(|warning| messages.warn(warning));
    summary(&report).iter().for_each(|line| messages.say(line));
    Ok(report)
}

/// Everything that the outputs of an entry depend on. Errors: a file cannot be read.
fn inputs_of(arguments: &BakeArguments, options: String) -> Result<OutputInputs, String> {
    let others = arguments.high.iter().chain(&arguments.cage);
    let others = others.map(|path| OutputInputs::new("bake", String::new(), path, &arguments.reading));
    let others: Vec<OutputInputs> = others.collect::<Result<_, _>>()?;
    let options = serde_json::to_string(&(options, others)).map_err(|error| error.to_string())?;
    OutputInputs::new("bake", options, &arguments.low, &arguments.reading)
}

fn totals(report: &JobReport) -> String {
    let mut parts = vec![counted(report.bakes.len(), "bake is done", "bakes are done")];
    if report.up_to_date > 0 {
        parts.push(counted(report.up_to_date, "was up to date", "were up to date"));
    }
    if !report.errors.is_empty() {
        parts.push(counted(report.errors.len(), "has failed", "have failed"));
    }
    parts.join(", ")
}

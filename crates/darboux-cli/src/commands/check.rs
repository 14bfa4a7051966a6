//! `darboux check`: prints what is wrong with models and normal maps.

pub mod arguments;
mod fix;
mod folder;
mod model;
mod report;
mod source;
mod text;

use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use darboux_check::{Finding, ReportedFinding, check_document, diagnosis};
use darboux_io::gltf::Document;
use darboux_io::system_reason;

use crate::batch;
use crate::documents::Source;
use crate::exit;
use crate::inputs::{FoundInputs, Input, SearchMode, UsageError, check_stdin, find_inputs};
use crate::json::to_json;
use crate::net;
use crate::terminal::{Messages, write_stdout};
use arguments::CheckArguments;
use fix::Repair;
use model::Model;
use report::{CheckReport, CheckedFile, ReportedMap};

/// Runs the command and returns its exit code.
pub fn run(arguments: &CheckArguments) -> u8 {
    let messages = Messages::new(arguments.messages.quiet);
    if let Some(code) = arguments.explain {
        return print(&messages, text::explain(code).as_bytes(), exit::DONE);
    }
    if let Err(UsageError(sentence)) = check_stdin(&arguments.files.inputs) {
        messages.error(&sentence);
        return exit::USAGE;
    }
    if let Some(code) = arguments.only.iter().find(|code| arguments.allow.contains(code)) {
        messages.error(&format!("--only and --allow both name {code}; name it once"));
        return exit::USAGE;
    }
    let found = find_inputs(&arguments.files.inputs, SearchMode::All);
    let inputs: Vec<&Input> = found.files.iter().map(|(input, _)| input).collect();
    let model = match Model::of(arguments, &inputs) {
        Ok(model) => model,
        Err(UsageError(sentence)) => {
            messages.error(&sentence);
            return exit::USAGE;
        }
    };
    warn_of_unused_maps(&found, arguments, &messages);
    if arguments.fix {
        return batch::run(&Repair { arguments, model });
    }
    let mut files: Vec<CheckedFile> = found
        .failed
        .iter()
        .map(|(path, reason)| {
            let maps = folder::maps_instead(path).map_or(String::new(), |clause| format!("; {clause}"));
            failed(path.display().to_string(), format!("{}: {reason}{maps}", path.display()))
        })
        .collect();
    files.extend(check_all(&inputs, arguments, &model));
    files.iter().filter_map(|file| file.error.as_ref()).for_each(|error| messages.error(error));
    let code = exit_code(&files, arguments);
    let report = CheckReport::new(files);
    let text = match (arguments.messages.json, arguments.messages.quiet) {
        (true, _) => to_json(&report),
        (false, is_quiet) => {
            let describe = |file| match (is_quiet, arguments.files.verbose) {
                (true, _) => text::failures(file, arguments.fail_on),
                (false, true) => text::describe(file),
                (false, false) => text::describe_folded(file),
            };
            let good = report.files.iter().filter(|file| file.error.is_none());
            let total =
                if is_quiet || report.files.len() < 2 { String::new() } else { text::total(&report.totals) };
            Ok((good.map(describe).collect::<String>() + &total).into_bytes())
        }
    };
    match text {
        Ok(text) => print(&messages, &text, code),
        Err(error) => {
            messages.error(&format!("the findings cannot be written: {}", error));
            exit::FAILED
        }
    }
}

/// Names the images of folders that are probably normal maps and that no model uses.
fn warn_of_unused_maps(found: &FoundInputs, arguments: &CheckArguments, messages: &Messages) {
    for folder in arguments.files.inputs.iter().filter(|path| path.is_dir() && !arguments.no_maps) {
        let of_folder = found.files.iter().filter(|(_, from)| from.as_ref() == Some(folder));
        let models: Vec<&Path> = of_folder
            .filter_map(|(input, _)| match input {
                Input::File(path) => Some(path.as_path()),
                Input::Stdin => None,
            })
            .collect();
        let unused = folder::unused_maps(folder, models.iter().copied()).filter(|_| !models.is_empty());
        unused.iter().for_each(|sentence| messages.warn(sentence));
    }
}

fn print(messages: &Messages, text: &[u8], code: u8) -> u8 {
    match write_stdout(text) {
        Ok(()) => code,
        Err(error) => {
            messages.error(&format!("the findings cannot be written: {}", system_reason(&error)));
            exit::FAILED
        }
    }
}

fn exit_code(files: &[CheckedFile], arguments: &CheckArguments) -> u8 {
    let fails = |file: &CheckedFile| {
        file.error.is_some()
            || file.findings.iter().any(|finding| arguments.fail_on.includes(finding.severity))
    };
    if files.iter().any(fails) { exit::FAILED } else { exit::DONE }
}

/// Checks files, several at the same time, in the order of the inputs.
fn check_all(inputs: &[&Input], arguments: &CheckArguments, model: &Model) -> Vec<CheckedFile> {
    let next = AtomicUsize::new(0);
    let checked: Vec<OnceLock<CheckedFile>> = inputs.iter().map(|_| OnceLock::new()).collect();
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(input) = inputs.get(number) else { return };
            // Every number is taken once.
            _ = checked[number].set(check_file(input, arguments, model));
        }
    };
    let cores = || thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let jobs = arguments.files.jobs.map_or_else(cores, |jobs| usize::from(jobs.get()));
    thread::scope(|scope| {
        for _ in 1..jobs.min(inputs.len()) {
            // Without a further thread, this one does the work.
            _ = thread::Builder::new().spawn_scoped(scope, work);
        }
        work();
    });
    checked.into_iter().filter_map(OnceLock::into_inner).collect()
}

fn check_file(input: &Input, arguments: &CheckArguments, model: &Model) -> CheckedFile {
    let options = arguments.check_options();
    let name = input.to_string();
    let reported = |findings: Vec<Finding>, map: Option<ReportedMap>, document: Option<&Document>| {
        let wanted = findings.into_iter().filter(|finding| arguments.reports(finding.code));
        let mut findings: Vec<ReportedFinding> = wanted.map(Into::into).collect();
        document.iter().for_each(|document| source::name_places(document, &mut findings));
        let importer = document.and_then(|document| source::importer_note(document, &findings));
        let diagnosis = diagnosis(&findings);
        CheckedFile { input: name.clone(), error: None, map, importer, diagnosis, findings }
    };
    let check = || {
        let source = Source::new(input)?;
        match source.image()? {
            Some(file) => {
                let checked = model.check_image(&file, &options)?;
                let map = ReportedMap::of(&checked);
                Ok(reported(checked.findings, map, None))
            }
            None => {
                let document = source.load(&arguments.files.reading)?;
                let findings = check_document(&document, &options).map_err(|error| error.to_string())?;
                Ok(reported(findings, None, Some(&document)))
            }
        }
    };
    net::catch(input, check).unwrap_or_else(|sentence: String| failed(name.clone(), sentence))
}

fn failed(input: String, sentence: String) -> CheckedFile {
    CheckedFile {
        input,
        error: Some(sentence),
        map: None,
        importer: None,
        diagnosis: String::new(),
        findings: Vec::new(),
    }
}

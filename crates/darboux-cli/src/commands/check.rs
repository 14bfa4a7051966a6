//! `darboux check`: prints what is wrong with models and normal maps.

pub mod arguments;
pub mod checks;
mod fix;
mod folder;
mod groups;
pub mod html;
pub mod model;
pub mod report;
mod text;

use std::path::Path;

use darboux_io::system_reason;

use crate::batch;
use crate::exit;
use crate::inputs::{FoundInputs, Input, SearchMode, UsageError, check_stdin, find_inputs};
use crate::json::to_json;
use crate::terminal::{Messages, write_stdout};
use arguments::{CheckArguments, FailOn};
use checks::Checks;
use fix::Repair;
use html::Page;
use model::Model;
use report::{CheckReport, CheckedFile};

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
    let refused = arguments.findings.refuse_contradictions().and_then(|()| match &arguments.report {
        Some(path) => html::refuse(path, &arguments.files.inputs),
        None => Ok(()),
    });
    if let Err(UsageError(sentence)) = refused {
        messages.error(&sentence);
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
    found.unread.iter().for_each(|sentence| messages.warn(sentence));
    let checks = Checks {
        findings: &arguments.findings,
        model,
        reading: arguments.files.reading,
        jobs: arguments.files.jobs,
    };
    let files = checks.check_found(&found, &messages);
    files.iter().filter_map(|file| file.error.as_ref()).for_each(|error| messages.error(error));
    let code = exit_code(&files, arguments.findings.fail_on);
    let report = CheckReport::new(files);
    if let Some(path) = &arguments.report {
        let page = Page { report: &report, checks: &checks, pictures: html::DEFAULT_PICTURES };
        if let Err(sentence) = page.write(path, true) {
            messages.error(&sentence);
            return exit::FAILED;
        }
    }
    let text = match (arguments.messages.json, arguments.messages.quiet) {
        (true, _) => to_json(&report),
        (false, is_quiet) => {
            let is_brief = report.files.len() > batch::MAX_DETAILED_FILES;
            let describe = |file| match (is_quiet, arguments.files.verbose) {
                (true, _) => text::failures(file, arguments.findings.fail_on),
                (false, true) => text::describe(file),
                (false, false) if is_brief => text::describe_briefly(file),
                (false, false) => text::describe_folded(file),
            };
            let good = report.files.iter().filter(|file| file.error.is_none());
            let mut text: String = good.map(describe).collect();
            let lists_some = !text.is_empty();
            if !is_quiet && report.files.len() > 1 {
                text += &text::total(&report);
            }
            if !is_quiet && is_brief && !arguments.files.verbose && lists_some {
                text += text::HOW_TO_SEE_MORE;
            }
            Ok(text.into_bytes())
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
    for folder in arguments.files.inputs.iter().filter(|path| path.is_dir() && !arguments.findings.no_maps) {
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

/// 1 if a file cannot be read or has a finding as severe as `fail_on`, otherwise 0.
pub fn exit_code(files: &[CheckedFile], fail_on: FailOn) -> u8 {
    let fails = |file: &CheckedFile| {
        file.error.is_some() || file.findings.iter().any(|finding| fail_on.includes(finding.severity))
    };
    if files.iter().any(fails) { exit::FAILED } else { exit::DONE }
}

//! `darboux inspect`: prints a table of the primitives of each file.

pub mod arguments;
mod recipe;
mod report;
mod table;

use darboux_io::gltf::inspect;
use darboux_io::system_reason;

use crate::documents::load;
use crate::exit;
use crate::inputs::{Input, SearchMode, UsageError, check_stdin, find_inputs};
use crate::json::{VERSION, to_json};
use crate::net;
use crate::options::reading::ReadOptions;
use crate::terminal::{Messages, write_stdout};
use arguments::InspectArguments;
use report::{InspectReport, InspectedFile, InspectedPrimitive};

/// Runs the command and returns its exit code.
pub fn run(arguments: &InspectArguments) -> u8 {
    let messages = Messages::new(arguments.messages.quiet);
    if let Err(UsageError(sentence)) = check_stdin(&arguments.inputs) {
        messages.error(&sentence);
        return exit::USAGE;
    }
    let found = find_inputs(&arguments.inputs, SearchMode::All);
    found.unread.iter().for_each(|sentence| messages.warn(sentence));
    let mut files: Vec<InspectedFile> =
        found.files.iter().map(|(input, _)| inspect_file(input, &arguments.reading)).collect();
    files.extend(found.failed.iter().map(|(path, reason)| {
        let path = path.display().to_string();
        let sentence = format!("{path}: {reason}");
        failed(path, sentence)
    }));
    let text = match (arguments.messages.json, arguments.messages.quiet) {
        (true, _) => to_json(&InspectReport { command: "inspect", version: VERSION, files: files.clone() }),
        (false, true) => Ok(Vec::new()),
        (false, false) => {
            let good = files.iter().filter(|file| file.error.is_none());
            Ok(good.map(table::describe).collect::<String>().into_bytes())
        }
    };
    if let Err(error) = text.map_err(std::io::Error::from).and_then(|text| write_stdout(&text)) {
        messages.error(&format!("the table cannot be written: {}", system_reason(&error)));
        return exit::FAILED;
    }
    print_problems(&files, &messages)
}

/// Prints the warnings and errors of all files and returns the exit code.
fn print_problems(files: &[InspectedFile], messages: &Messages) -> u8 {
    for file in files {
        file.warnings.iter().for_each(|warning| messages.warn(&format!("{}: {warning}", file.input)));
    }
    let errors: Vec<&String> = files.iter().filter_map(|file| file.error.as_ref()).collect();
    errors.iter().for_each(|error| messages.error(error));
    if errors.is_empty() { exit::DONE } else { exit::FAILED }
}

fn inspect_file(input: &Input, reading: &ReadOptions) -> InspectedFile {
    let inspected = net::catch(input, || {
        let document = load(input, reading)?;
        let infos = inspect(&document).map_err(|error| error.to_string())?;
        let recipes = recipe::recipes(&document, &infos).map_err(|error| error.to_string())?;
        let with_recipe = |(info, made_by)| InspectedPrimitive { info, made_by };
        let primitives = infos.into_iter().zip(recipes).map(with_recipe).collect();
        Ok(InspectedFile {
            input: input.to_string(),
            error: None,
            warnings: document.warnings().to_vec(),
            primitives,
        })
    });
    inspected.unwrap_or_else(|sentence| failed(input.to_string(), sentence))
}

fn failed(input: String, sentence: String) -> InspectedFile {
    InspectedFile { input, error: Some(sentence), warnings: Vec::new(), primitives: Vec::new() }
}

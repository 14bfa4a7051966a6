//! `darboux report`: checks models and writes what is wrong as one HTML file.

pub mod arguments;

use crate::commands::check::checks::Checks;
use crate::commands::check::exit_code;
use crate::commands::check::html::{self, Page};
use crate::commands::check::model::Model;
use crate::commands::check::report::CheckReport;
use crate::exit;
use crate::inputs::{SearchMode, UsageError, find_inputs};
use crate::terminal::Messages;
use crate::text::counted;
use arguments::ReportArguments;

/// Runs the command and returns its exit code.
pub fn run(arguments: &ReportArguments) -> u8 {
    let ReportArguments { inputs, output, force, pictures, findings, reading, quiet } = arguments;
    let messages = Messages::new(*quiet);
    let refused = findings.refuse_contradictions().and_then(|()| html::refuse(output, inputs));
    if let Err(UsageError(sentence)) = refused {
        messages.error(&sentence);
        return exit::USAGE;
    }
    if output.exists() && !force {
        let name = output.display();
        messages.error(&format!("{name}: exists; use --force to replace it, or choose another name"));
        return exit::FAILED;
    }
    let checks = Checks { findings, model: Model::none(), reading: *reading, jobs: None };
    let found = find_inputs(inputs, SearchMode::All);
    found.unread.iter().for_each(|sentence| messages.warn(sentence));
    let files = checks.check_found(&found, &messages);
    files.iter().filter_map(|file| file.error.as_ref()).for_each(|error| messages.error(error));
    let code = exit_code(&files, findings.fail_on);
    let report = CheckReport::new(files);
    let page = Page { report: &report, checks: &checks, pictures: *pictures };
    if let Err(sentence) = page.write(output, *force) {
        messages.error(&sentence);
        return exit::FAILED;
    }
    let totals = &report.totals;
    messages.say(&format!(
        "{}: {}, {} with errors, {} with warnings only",
        output.display(),
        counted(totals.files, "file", "files"),
        totals.with_errors,
        totals.with_warnings
    ));
    code
}

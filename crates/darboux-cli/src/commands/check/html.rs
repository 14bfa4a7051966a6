//! The findings as one HTML file that needs no network: the diagnosis first, pictures before and after the
//! repair, findings by kind.

mod file;
#[cfg(not(feature = "gpu"))]
mod no_painter;
#[cfg(feature = "gpu")]
mod painter;
mod pictures;
mod shared;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use darboux_check::Severity;
use darboux_io::words::Count;
use darboux_io::{Outputs, SaveOptions};

use super::checks::Checks;
use super::report::{CheckReport, CheckedFile};
use crate::html_page::{HtmlPage, escaped, refuse_no_page};
use crate::inputs::{Input, UsageError};
use crate::interrupt;
use crate::text::counted;
#[cfg(not(feature = "gpu"))]
use no_painter::Painter;
#[cfg(feature = "gpu")]
use painter::Painter;
use pictures::Pictures;
use shared::worst;

/// The number of files that have pictures, unless another one is chosen.
pub const DEFAULT_PICTURES: usize = 20;

/// The CSS rules of this page.
const STYLE: &str = include_str!("html/report.css");
const SCRIPT: &str = include_str!("html/report.js");

/// Refuses an output that is no HTML file in an existing folder, and standard input, whose model cannot be
/// read again for pictures.
pub fn refuse(output: &Path, inputs: &[PathBuf]) -> Result<(), UsageError> {
    refuse_no_page(output).map_err(UsageError)?;
    if inputs.iter().any(|input| input == Path::new("-")) {
        return Err(UsageError(
            "a report reads models twice; save standard input to a file first".to_owned(),
        ));
    }
    Ok(())
}

/// A report as a page.
pub struct Page<'a> {
    pub report: &'a CheckReport,
    pub checks: &'a Checks<'a>,
    /// The number of files that have pictures: the worst ones.
    pub pictures: usize,
}

impl Page<'_> {
    /// Writes the page. `force`: whether it replaces an existing file. The error is one sentence.
    pub fn write(&self, path: &Path, force: bool) -> Result<(), String> {
        let text = self.text();
        let _guard = interrupt::writing();
        let mut outputs = Outputs::new(None);
        let options = SaveOptions::default().with_force(force);
        let staged = outputs.stage_bytes(path, text.as_bytes(), &options);
        staged.and_then(|()| outputs.commit()).map(|_| ()).map_err(|error| error.to_string())
    }

    fn text(&self) -> String {
        let files = &self.report.files;
        let mut pictures = self.draw();
        let of_file = |(number, checked): (usize, &CheckedFile)| {
            file::section(number, checked, pictures.remove(&number).unwrap_or(Pictures::None(None)))
        };
        let sections: String = files.iter().enumerate().map(of_file).collect();
        let contents = if files.len() < 2 { String::new() } else { contents(files) };
        let page = HtmlPage {
            title: "Darboux report",
            summary: &summary(self.report),
            contents,
            main: sections,
            style: STYLE,
            script: SCRIPT,
        };
        page.text()
    }

    /// Draws the worst files with findings, by their numbers.
    fn draw(&self) -> BTreeMap<usize, Pictures> {
        let files = &self.report.files;
        let mut drawn: Vec<usize> = (0..files.len())
            .filter(|number| files[*number].map.is_none() && worst(&files[*number]) > Some(Severity::Info))
            .collect();
        drawn.sort_by_key(|number| std::cmp::Reverse(worst(&files[*number])));
        let without_pictures = drawn.split_off(drawn.len().min(self.pictures));
        let mut pictures = BTreeMap::new();
        if !drawn.is_empty() {
            let painter = Painter::open(self.checks);
            for number in drawn {
                let input = Input::File(PathBuf::from(&files[number].input));
                pictures.insert(number, painter.draw(&input));
            }
        }
        let reason = format!("Only the worst {} have pictures.", counted(self.pictures, "file", "files"));
        pictures.extend(
            without_pictures.into_iter().map(|number| (number, Pictures::None(Some(reason.clone())))),
        );
        pictures
    }
}

/// How many files have what, as a sentence.
fn summary(report: &CheckReport) -> String {
    let totals = &report.totals;
    let failed = match totals.failed {
        0 => String::new(),
        count => format!(", {} that cannot be read", Count(count)),
    };
    format!(
        "{}: {} with errors, {} with warnings only, {} without{failed}.",
        counted(totals.files, "file", "files"),
        totals.with_errors,
        totals.with_warnings,
        totals.healthy
    )
}

/// The list of files, each with what it has.
fn contents(files: &[CheckedFile]) -> String {
    let entry = |(number, checked): (usize, &CheckedFile)| {
        let (class, word) = file::verdict(checked);
        let name = escaped(&checked.input);
        format!("<li class=\"{class}\"><a href=\"#file-{number}\">{name}</a> <span>{word}</span></li>\n")
    };
    let entries: String = files.iter().enumerate().map(entry).collect();
    format!("<nav aria-label=\"Files\">\n<ul>\n{entries}</ul>\n</nav>\n")
}

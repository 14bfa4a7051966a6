//! `darboux check --fix`: repairs models and normal maps, and says what was repaired.

use darboux::TangentOptions;
use darboux_check::{Code, FixOptions, FixedFinding, Severity, check_document, fix_document};
use darboux_io::image::PngImage;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::arguments::CheckArguments;
use super::model::Model;
use super::report::ReportedFinding;
use crate::batch::command::{FileCommand, ProcessedFile};
use crate::batch::plan::Job;
use crate::batch::report::{FileReport, Status, SummarySource};
use crate::documents::{Source, save, save_image};
use crate::inputs::{Input, output_suffix};
use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;
use crate::paths::is_png;
use crate::terminal::FileProgress;
use crate::text::counted;

/// The report of a file.
#[derive(Default, Serialize)]
pub struct FixSummary {
    pub findings: Vec<ReportedFinding>,
    pub warnings: Vec<String>,
}

/// The command with `--fix`.
pub struct Repair<'a> {
    pub arguments: &'a CheckArguments,
    pub model: Model,
}

impl FileCommand for Repair<'_> {
    type Summary = FixSummary;

    const NAME: &'static str = "check";
    const IMAGES: bool = true;

    fn suffix(&self) -> &str {
        output_suffix::FIXED
    }

    fn files(&self) -> &FileOptions {
        &self.arguments.files
    }

    fn messages(&self) -> &MessageOptions {
        &self.arguments.messages
    }

    fn options(&self) -> String {
        format!("{:?}", (self.arguments.fix_options(), &self.arguments.model))
    }

    fn process(&self, job: &Job, _: &FileProgress<'_>) -> Result<ProcessedFile<FixSummary>, String> {
        let source = Source::new(&job.input)?;
        match source.image()? {
            Some(file) => self.fix_image(file.into_owned(), job),
            None => self.fix_model(&source, job),
        }
    }

    fn fails(&self, summary: &SummarySource<FixSummary>) -> bool {
        let mut left = Outcome::all_of(summary).into_iter().filter(|finding| !finding.repaired);
        left.any(|finding| self.arguments.fail_on.includes(finding.severity))
    }

    fn note_up_to_date(recorded: &Map<String, Value>) -> Option<String> {
        let left = Outcome::recorded(recorded).iter().filter(|finding| finding.is_left()).count();
        (left > 0).then(|| format!("{} left", counted(left, "finding", "findings")))
    }

    fn lines(summary: &FixSummary) -> Vec<String> {
        summary.findings.iter().filter_map(line).collect()
    }

    fn errors(summary: &FixSummary) -> Vec<String> {
        summary.findings.iter().filter_map(error_line).collect()
    }

    fn warnings(summary: &FixSummary) -> &[String] {
        &summary.warnings
    }

    fn total(files: &[FileReport<FixSummary>]) -> String {
        let this_run = files.iter().filter_map(|file| file.summary.this_run());
        let repaired =
            this_run.flat_map(|summary| &summary.findings).filter(|finding| finding.repaired == Some(true));
        let all: Vec<Outcome> = files.iter().flat_map(|file| Outcome::all_of(&file.summary)).collect();
        let left = all.iter().filter(|finding| finding.is_left()).count();
        let infos = all.iter().filter(|finding| !finding.repaired && !finding.is_left()).count();
        let repaired = counted(repaired.count(), "finding repaired", "findings repaired");
        format!("{repaired}, {left} left, {infos} worth knowing")
    }
}

/// What became of a finding, in this run or in an earlier one.
#[derive(Clone, Copy, Deserialize)]
struct Outcome {
    severity: Severity,
    repaired: bool,
}

impl Outcome {
    fn all_of(summary: &SummarySource<FixSummary>) -> Vec<Self> {
        match summary {
            SummarySource::ThisRun(summary) => summary.findings.iter().map(Self::of).collect(),
            SummarySource::Journal(recorded) => Self::recorded(recorded),
        }
    }

    fn of(finding: &ReportedFinding) -> Self {
        Self { severity: finding.severity, repaired: finding.repaired == Some(true) }
    }

    /// From the journal, which nobody but this command writes.
    fn recorded(summary: &Map<String, Value>) -> Vec<Self> {
        let findings = summary.get("findings").cloned();
        findings.and_then(|findings| serde_json::from_value(findings).ok()).unwrap_or_default()
    }

    /// Whether it is worth mentioning that the finding was not repaired.
    fn is_left(self) -> bool {
        !self.repaired && self.severity > Severity::Info
    }
}

fn line(finding: &ReportedFinding) -> Option<String> {
    let ReportedFinding { place, code, text, left_because, .. } = finding;
    let outcome = Outcome::of(finding);
    match (code.repair(), left_because) {
        (Some(repair), _) if outcome.repaired => Some(format!("{place}: repaired {code}: {text}; {repair}")),
        (_, Some(reason)) if outcome.is_left() => Some(format!("{place}: left {code}: {text}; {reason}")),
        _ => None,
    }
}

/// An error that was not repaired, in one line.
fn error_line(finding: &ReportedFinding) -> Option<String> {
    let ReportedFinding { place, code, text, severity, .. } = finding;
    let is_left = *severity == Severity::Error && finding.repaired != Some(true);
    is_left.then(|| format!("{place}: {code}: {text}"))
}

impl CheckArguments {
    fn fix_options(&self) -> FixOptions {
        let codes = Code::ALL.iter().copied().filter(|&code| self.reports(code));
        FixOptions::default()
            .with_check(self.check_options())
            .with_tangents(TangentOptions::from(darboux::Method::from(self.method)))
            .with_normals(self.normals.options())
            .with_codes(codes)
    }
}

impl Repair<'_> {
    fn fix_model(&self, source: &Source<'_>, job: &Job) -> Result<ProcessedFile<FixSummary>, String> {
        let sentence = |error: darboux_io::Error| error.to_string();
        let CheckArguments { files, .. } = self.arguments;
        let reading = &files.reading;
        // The check decompresses a document, and the repair of a map should not: it starts from another copy.
        let findings =
            check_document(&mut source.load(reading)?, &self.arguments.check_options()).map_err(sentence)?;
        let mut document = source.load(reading)?;
        let fixed = fix_document(&mut document, findings, &self.arguments.fix_options()).map_err(sentence)?;
        if !fixed.is_changed {
            document = source.load(reading)?;
        }
        let warnings = document.warnings().to_vec();
        let (status, files_written) = save(&document, &job.output, files, fixed.is_changed)?;
        Ok(ProcessedFile { status, files_written, summary: self.summary(fixed.findings, warnings) })
    }

    fn fix_image(&self, file: Vec<u8>, job: &Job) -> Result<ProcessedFile<FixSummary>, String> {
        let name = job.input.to_string();
        let files = &self.arguments.files;
        let loading = files.reading.load_options();
        let fixed = self.model.fix_image(&name, &file, &loading, &self.arguments.fix_options())?;
        let becomes_png = matches!(&job.input, Input::File(path) if !is_png(path));
        if fixed.image.is_some() && files.in_place && becomes_png {
            return Err(format!(
                "{name}: is repaired into a PNG, which cannot take its place; use -o FILE.png"
            ));
        }
        let image = fixed.image.or_else(|| PngImage::from_bytes(&name, file, &loading).ok());
        let (status, files_written) = match image {
            Some(image) => save_image(&image, &job.output, files)?,
            // Without a repair there is nothing to write but a copy, and copies are made of PNG images that can be written again.
            None => (Status::Untouched, Vec::new()),
        };
        Ok(ProcessedFile { status, files_written, summary: self.summary(fixed.findings, Vec::new()) })
    }

    fn summary(&self, fixed: Vec<FixedFinding>, warnings: Vec<String>) -> FixSummary {
        let reported = fixed.into_iter().filter(|fixed| self.arguments.reports(fixed.finding.code));
        FixSummary { findings: reported.map(Into::into).collect(), warnings }
    }
}

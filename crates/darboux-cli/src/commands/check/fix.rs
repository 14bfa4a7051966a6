//! `darboux check --fix`: repairs models and normal maps, and says what was cured.

use std::fs;
use std::path::Path;

use darboux::TangentOptions;
use darboux_check::{Code, FixOptions, FixedFinding, Severity, check_document, fix_document, fix_map};
use darboux_io::image::PngImage;
use serde::Serialize;

use super::arguments::CheckArguments;
use super::is_image;
use super::report::ReportedFinding;
use crate::batch::command::{FileCommand, ProcessedFile};
use crate::batch::plan::Job;
use crate::batch::report::FileReport;
use crate::documents::{Source, save, save_image};
use crate::inputs::{Input, UsageError, output_suffix};
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

impl FileCommand for CheckArguments {
    type Summary = FixSummary;

    const NAME: &'static str = "check";
    const IMAGES: bool = true;

    fn suffix(&self) -> &str {
        output_suffix::FIXED
    }

    fn files(&self) -> &FileOptions {
        &self.files
    }

    fn messages(&self) -> &MessageOptions {
        &self.messages
    }

    fn check(&self) -> Result<(), UsageError> {
        Ok(())
    }

    fn options(&self) -> String {
        format!("{:?}", self.fix_options())
    }

    fn process(&self, job: &Job, _: &FileProgress<'_>) -> Result<ProcessedFile<FixSummary>, String> {
        match &job.input {
            Input::File(path) if is_image(path) => self.fix_image(path, job),
            _ => self.fix_model(job),
        }
    }

    fn fails(&self, summary: &FixSummary) -> bool {
        let left = summary.findings.iter().filter(|finding| finding.cured == Some(false));
        left.into_iter().any(|finding| self.fail_on.includes(finding.severity))
    }

    fn lines(summary: &FixSummary) -> Vec<String> {
        summary.findings.iter().filter_map(line).collect()
    }

    fn warnings(summary: &FixSummary) -> &[String] {
        &summary.warnings
    }

    fn total(files: &[FileReport<FixSummary>]) -> String {
        let findings = || {
            let summaries = files.iter().filter_map(|file| file.summary.this_run());
            summaries.flat_map(|summary| &summary.findings)
        };
        let cured = findings().filter(|finding| finding.cured == Some(true)).count();
        let left = findings().filter(|finding| is_left(finding)).count();
        format!("{} cured, {left} left", counted(cured, "finding", "findings"))
    }
}

/// Whether a finding is worth mentioning that it was not cured.
fn is_left(finding: &ReportedFinding) -> bool {
    finding.cured == Some(false) && finding.severity > Severity::Info
}

fn line(finding: &ReportedFinding) -> Option<String> {
    let ReportedFinding { place, code, text, cured, left_because, .. } = finding;
    match (cured, left_because) {
        (Some(true), _) => Some(format!("{place}: cured {code}: {text}")),
        (_, Some(reason)) if is_left(finding) => Some(format!("{place}: left {code}: {text}; {reason}")),
        _ => None,
    }
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

    fn fix_model(&self, job: &Job) -> Result<ProcessedFile<FixSummary>, String> {
        let sentence = |error: darboux_io::Error| error.to_string();
        let (source, reading) = (Source::new(&job.input)?, &self.files.reading);
        // The check decompresses a document, and the repair of a map should not: it starts from another copy.
        let findings = check_document(&mut source.load(reading)?, &self.check_options()).map_err(sentence)?;
        let mut document = source.load(reading)?;
        let fixed = fix_document(&mut document, findings, &self.fix_options()).map_err(sentence)?;
        let is_changed = fixed.iter().any(|fixed| fixed.cured);
        if !is_changed {
            document = source.load(reading)?;
        }
        let warnings = document.warnings().to_vec();
        let (status, files_written) = save(&document, &job.output, &self.files, is_changed)?;
        Ok(ProcessedFile { status, files_written, summary: self.summary(fixed, warnings) })
    }

    fn fix_image(&self, path: &Path, job: &Job) -> Result<ProcessedFile<FixSummary>, String> {
        let name = path.display().to_string();
        if !is_png(path) {
            return Err(format!("{name}: only PNG maps are repaired; save it as a PNG first"));
        }
        let sentence = |error: darboux_io::Error| error.to_string();
        let file = fs::read(path).map_err(|error| format!("{name}: cannot be read: {error}"))?;
        let loading = self.files.reading.load_options();
        let fixed = fix_map(&name, &file, &loading, &self.fix_options()).map_err(sentence)?;
        let image = match fixed.image {
            Some(image) => image,
            None => PngImage::from_bytes(&name, file, &loading).map_err(sentence)?,
        };
        let (status, files_written) = save_image(&image, &job.output, &self.files)?;
        Ok(ProcessedFile { status, files_written, summary: self.summary(fixed.findings, Vec::new()) })
    }

    fn summary(&self, fixed: Vec<FixedFinding>, warnings: Vec<String>) -> FixSummary {
        let reported = fixed.into_iter().filter(|fixed| self.reports(fixed.finding.code));
        FixSummary { findings: reported.map(Into::into).collect(), warnings }
    }
}

//! `darboux check --fix`: repairs models and normal maps, and says what was repaired.

use std::path::Path;

use darboux::TangentOptions;
use darboux_check::{
    Change, Code, Finding, FixOptions, FixedFinding, ReportedFinding, Severity, check_document, diagnosis,
    fix_document, plan_repair,
};
use darboux_io::gltf::Document;
use darboux_io::image::PngImage;
use darboux_io::{FileKind, read_regular};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::arguments::{CheckArguments, FindingOptions};
use super::model::Model;
use super::report::ReportedEdit;
use crate::batch::command::{FileCommand, ProcessedFile};
use crate::batch::plan::{Job, Output};
use crate::batch::report::{FileReport, Status, SummarySource};
use crate::documents::{Source, left_out, save, save_image};
use crate::inputs::{Input, output_suffix};
use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;
use crate::paths::is_png;
use crate::terminal::FileProgress;
use crate::text::counted;

/// The report of a file.
#[derive(Default, Serialize)]
pub struct FixSummary {
    /// What happened, what it looks like and what to do about what is left.
    pub diagnosis: String,
    pub findings: Vec<ReportedFinding>,
    /// The edits with which a repair would begin, with `--dry-run`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planned: Option<Vec<ReportedEdit>>,
    pub warnings: Vec<String>,
    /// Whether the output has no place for tangents.
    #[serde(skip)]
    pub drops_tangents: bool,
}

/// The command with `--fix`.
pub struct Repair<'a> {
    pub arguments: &'a CheckArguments,
    pub model: Model,
}

impl FileCommand for Repair<'_> {
    type Summary = FixSummary;
    type Totals = FixCounts;

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

    fn common_input(&self) -> Option<&Path> {
        self.arguments.model.as_deref()
    }

    fn compares_existing(&self) -> bool {
        self.arguments.dry_run || !self.arguments.files.names_output()
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
        left.any(|finding| self.arguments.findings.fail_on.includes(finding.severity))
    }

    fn note_up_to_date(recorded: &Map<String, Value>) -> Option<String> {
        let left = Outcome::recorded(recorded).iter().filter(|finding| finding.remains()).count();
        (left > 0).then(|| format!("{} left", counted(left, "finding", "findings")))
    }

    fn lines(summary: &FixSummary) -> Vec<String> {
        let planned = summary.planned.iter().flatten();
        let planned = planned.map(|edit| format!("{}: would {}", edit.place, edit.action));
        let lines = summary.findings.iter().filter_map(|finding| line(finding, summary.drops_tangents));
        planned.chain(lines).collect()
    }

    fn errors(summary: &FixSummary) -> Vec<String> {
        summary.findings.iter().filter_map(error_line).collect()
    }

    fn warnings(summary: &FixSummary) -> &[String] {
        &summary.warnings
    }

    fn count(counts: &mut FixCounts, file: &FileReport<FixSummary>) {
        let planned = file.summary.this_run().and_then(|summary| summary.planned.as_ref());
        if let Some(edits) = planned {
            *counts.planned.get_or_insert_default() += edits.len();
        }
        let is_this_run = file.summary.this_run().is_some();
        for finding in Outcome::all_of(&file.summary) {
            let is_unrepairable = finding.remains() && !finding.fixable;
            let is_info = !finding.repaired && !finding.is_left() && !finding.remains();
            counts.repaired += usize::from(finding.repaired && is_this_run);
            counts.left += usize::from(finding.is_left());
            counts.unrepairable += usize::from(is_unrepairable);
            counts.infos += usize::from(is_info);
        }
    }

    fn total(counts: &FixCounts) -> String {
        if let Some(edits) = counts.planned {
            return format!("{} planned", counted(edits, "edit", "edits"));
        }
        let repaired = counted(counts.repaired, "finding repaired", "findings repaired");
        let left = match counts.left {
            0 => String::new(),
            left => format!("{left} left although --fix repairs such ones, "),
        };
        let FixCounts { unrepairable, infos, .. } = counts;
        format!("{repaired}, {left}{unrepairable} that --fix leaves, {infos} only worth knowing")
    }
}

/// The findings of the files of a run.
#[derive(Default)]
pub struct FixCounts {
    /// The edits that are planned; `None` where repairs are made.
    planned: Option<usize>,
    /// In this run.
    repaired: usize,
    left: usize,
    unrepairable: usize,
    infos: usize,
}

/// What became of a finding, in this run or in an earlier one.
#[derive(Clone, Copy, Deserialize)]
struct Outcome {
    severity: Severity,
    repaired: bool,
    fixable: bool,
}

impl Outcome {
    fn all_of(summary: &SummarySource<FixSummary>) -> Vec<Self> {
        match summary {
            SummarySource::ThisRun(summary) => summary.findings.iter().map(Self::of).collect(),
            SummarySource::Journal(recorded) => Self::recorded(recorded),
        }
    }

    fn of(finding: &ReportedFinding) -> Self {
        let ReportedFinding { severity, fixable, repaired, .. } = *finding;
        Self { severity, repaired: repaired == Some(true), fixable }
    }

    /// From the journal, which nobody but this command writes.
    fn recorded(summary: &Map<String, Value>) -> Vec<Self> {
        let findings = summary.get("findings").cloned();
        findings.and_then(|findings| serde_json::from_value(findings).ok()).unwrap_or_default()
    }

    /// Whether it is worth mentioning that the finding is still there.
    fn remains(self) -> bool {
        !self.repaired && self.severity > Severity::Info
    }

    /// Whether the finding could have been repaired, and was not.
    fn is_left(self) -> bool {
        !self.repaired && self.fixable
    }
}

fn line(finding: &ReportedFinding, drops_tangents: bool) -> Option<String> {
    let ReportedFinding { place, code, text, left_because, .. } = finding;
    let outcome = Outcome::of(finding);
    match (code.repair(), left_because) {
        (Some(_), _) if outcome.repaired && drops_tangents && code.is_about_tangents() => Some(format!(
            "{place}: gone {code}: {text}; an OBJ has no tangents, and an importer computes its own"
        )),
        (Some(repair), _) if outcome.repaired => {
            let done = done(*code, finding.change, repair);
            Some(format!("{place}: repaired {code}: {text}; {done}"))
        }
        (None, _) if outcome.repaired => {
            Some(format!("{place}: gone {code}: {text}; with what was repaired"))
        }
        (_, Some(reason)) if outcome.remains() || outcome.is_left() => {
            Some(format!("{place}: left {code}: {text}; {reason}"))
        }
        _ => None,
    }
}

/// What was done, as a clause. `repair`: what is usually done for the code.
fn done(code: Code, change: Option<Change>, repair: &str) -> String {
    let of_tangents = match change {
        Some(Change::RecomputedTangents) => "all tangents of the primitive were computed again".to_owned(),
        Some(Change::CorrectedTangents { count }) => {
            let corrected = counted(count, "tangent was corrected", "tangents were corrected");
            format!("{corrected}, and the others kept")
        }
        _ => return repair.to_owned(),
    };
    // The map was repaired, too.
    if code == Code::ConventionsCancel { format!("{repair}: {of_tangents}") } else { of_tangents }
}

/// An error that was not repaired, in one line.
fn error_line(finding: &ReportedFinding) -> Option<String> {
    let ReportedFinding { place, code, text, severity, .. } = finding;
    let is_left = *severity == Severity::Error && finding.repaired != Some(true);
    is_left.then(|| format!("{place}: {code}: {text}"))
}

impl CheckArguments {
    fn fix_options(&self) -> FixOptions {
        let FindingOptions { only, allow, .. } = &self.findings;
        let options = FixOptions::default()
            .with_check(self.findings.check_options())
            .with_tangents(TangentOptions::from(self.method))
            .with_normals(self.normals.options())
            .without_codes(allow.iter().copied());
        if only.is_empty() { options } else { options.with_codes(only.iter().copied()) }
    }
}

impl Repair<'_> {
    fn fix_model(&self, source: &Source<'_>, job: &Job) -> Result<ProcessedFile<FixSummary>, String> {
        let sentence = |error: darboux_io::Error| error.to_string();
        let CheckArguments { files, .. } = self.arguments;
        let reading = &files.reading;
        let mut document = source.load(reading)?;
        let findings =
            check_document(&document, &self.arguments.findings.check_options()).map_err(sentence)?;
        let options = self.arguments.fix_options();
        if self.arguments.dry_run {
            return self.planned(&document, findings, &options).map_err(sentence);
        }
        let fixed = fix_document(&mut document, findings, &options).map_err(sentence)?;
        let mut warnings = document.warnings().to_vec();
        warnings.extend(self.stale_output(job, fixed.is_changed));
        warnings.extend(left_out(&document, &job.output)?);
        let is_written = |existing: &Path| document.is_saved_at(existing);
        let (status, files_written) = match self.written_before(&job.output, fixed.is_changed, is_written)? {
            Some(status) => (status, Vec::new()),
            None => save(&document, &job.output, files, fixed.is_changed)?,
        };
        let drops_tangents =
            matches!(&job.output, Output::File(path) if FileKind::of(path) == Some(FileKind::Obj));
        let summary = FixSummary { drops_tangents, ..self.summary(fixed.findings, warnings) };
        Ok(ProcessedFile { status, files_written, summary })
    }

    /// What a repair of a document would begin with.
    fn planned(
        &self,
        document: &Document,
        findings: Vec<Finding>,
        options: &FixOptions,
    ) -> Result<ProcessedFile<FixSummary>, darboux_io::Error> {
        let planned = plan_repair(document, &findings, options)?.into_iter().map(Into::into).collect();
        let reported = options
            .with_reasons(findings)
            .into_iter()
            .filter(|finding| self.arguments.findings.reports(finding.code));
        let findings: Vec<ReportedFinding> = reported.map(Into::into).collect();
        let summary = FixSummary {
            diagnosis: diagnosis(&findings, &options.check),
            findings,
            planned: Some(planned),
            warnings: document.warnings().to_vec(),
            drops_tangents: false,
        };
        Ok(ProcessedFile { status: Status::Untouched, files_written: Vec::new(), summary })
    }

    fn fix_image(&self, file: Vec<u8>, job: &Job) -> Result<ProcessedFile<FixSummary>, String> {
        let name = job.input.to_string();
        let files = &self.arguments.files;
        let loading = files.reading.load_options();
        let fixed = self.model.fix_image(&name, &file, &loading, &self.arguments.fix_options())?;
        if self.arguments.dry_run {
            return Ok(self.planned_texels(fixed.findings));
        }
        let becomes_png = matches!(&job.input, Input::File(path) if !is_png(path));
        if fixed.image.is_some() && files.in_place && becomes_png {
            return Err(format!(
                "{name}: is repaired into a PNG, which cannot take its place; use -o FILE.png"
            ));
        }
        let image = fixed.image.or_else(|| PngImage::from_bytes(&name, file, &loading).ok());
        let is_written = |existing: &Path| {
            let new = image.as_ref().and_then(|image| image.to_bytes().ok());
            new.is_some_and(|new| read_regular(existing).is_ok_and(|existing| existing == new))
        };
        let is_changed = image.as_ref().is_some_and(PngImage::is_changed);
        let status = self.written_before(&job.output, is_changed, is_written)?;
        let (status, files_written) = match image.filter(|_| status.is_none()) {
            Some(image) => save_image(&image, &job.output, files)?,
            // Without a repair there is nothing to write but a copy, and copies are made of PNG images that
            // can be written again.
            None => (status.unwrap_or(Status::Untouched), Vec::new()),
        };
        let warnings = self.stale_output(job, is_changed).into_iter().collect();
        Ok(ProcessedFile { status, files_written, summary: self.summary(fixed.findings, warnings) })
    }

    /// What a repair of an image would do: it is done, and not written.
    fn planned_texels(&self, fixed: Vec<FixedFinding>) -> ProcessedFile<FixSummary> {
        let repaired = fixed.iter().filter(|fixed| fixed.repaired);
        let planned = repaired.map(|fixed| ReportedEdit::of(&fixed.finding)).collect();
        let summary = FixSummary { planned: Some(planned), ..FixSummary::default() };
        ProcessedFile { status: Status::Untouched, files_written: Vec::new(), summary }
    }

    /// A warning where an output of the name that this run would give is there, and nothing is written
    /// because nothing was repaired.
    fn stale_output(&self, job: &Job, is_changed: bool) -> Option<String> {
        let Output::File(path) = &job.output else { return None };
        let is_stale = !is_changed && !self.arguments.files.names_output() && path.exists();
        is_stale.then(|| {
            format!(
                "{} exists and was not written, because nothing was repaired; delete it if \
             an earlier run made it",
                path.display()
            )
        })
    }

    /// The status where nothing is to be written: without a named output, nothing was changed, or an earlier
    /// run has written the same; none otherwise. Errors: an output exists that is another.
    fn written_before(
        &self,
        output: &Output,
        is_changed: bool,
        is_written: impl FnOnce(&Path) -> bool,
    ) -> Result<Option<Status>, String> {
        let Output::File(path) = output else { return Ok(None) };
        let files = &self.arguments.files;
        if files.names_output() {
            Ok(None)
        } else if !is_changed {
            Ok(Some(Status::Untouched))
        } else if files.force || !path.exists() {
            Ok(None)
        } else if is_written(path) {
            Ok(Some(Status::UpToDate))
        } else {
            Err(format!(
                "{output}: exists, and other data would be written; use --force to replace it, or name \
                 another output"
            ))
        }
    }

    fn summary(&self, fixed: Vec<FixedFinding>, warnings: Vec<String>) -> FixSummary {
        let reported = fixed.into_iter().filter(|fixed| self.arguments.findings.reports(fixed.finding.code));
        let findings: Vec<ReportedFinding> = reported.map(Into::into).collect();
        let diagnosis = diagnosis(&findings, &self.arguments.findings.check_options());
        FixSummary { diagnosis, findings, warnings, ..FixSummary::default() }
    }
}

//! The JSON report of `darboux check`. json.txt documents its fields.

use std::collections::BTreeMap;

use darboux::{BitangentDirection, Choice, MapJudgement, TangentDirection};
use darboux_check::{
    CheckedMap, Code, Finding, MapDirections, Place, PlannedEdit, ReportedFinding, Severity,
};
use serde::Serialize;

use crate::json::VERSION;

/// The report of a run.
#[derive(Serialize)]
pub struct CheckReport {
    pub command: &'static str,
    pub version: &'static str,
    pub files: Vec<CheckedFile>,
    pub totals: CheckTotals,
}

impl CheckReport {
    /// The report of these files.
    pub fn new(files: Vec<CheckedFile>) -> Self {
        Self { command: "check", version: VERSION, totals: CheckTotals::of(&files), files }
    }
}

/// The findings of all files.
#[derive(Serialize)]
pub struct CheckTotals {
    pub files: usize,
    /// The files that cannot be read.
    pub failed: usize,
    /// The files with errors, with warnings and no error, and with neither.
    pub with_errors: usize,
    pub with_warnings: usize,
    pub healthy: usize,
    /// The findings by severity and code.
    pub errors: BTreeMap<Code, usize>,
    pub warnings: BTreeMap<Code, usize>,
    pub infos: BTreeMap<Code, usize>,
    pub not_checked: BTreeMap<Code, usize>,
}

impl CheckTotals {
    fn of(files: &[CheckedFile]) -> Self {
        let by_code = |severity: Severity| {
            let mut counts = BTreeMap::new();
            let findings = files.iter().flat_map(|file| &file.findings);
            for finding in findings.filter(|finding| finding.severity == severity) {
                *counts.entry(finding.code).or_default() += 1;
            }
            counts
        };
        let worst = |file: &CheckedFile| file.findings.iter().map(|finding| finding.severity).max();
        let read = || files.iter().filter(|file| file.error.is_none());
        let count = |severity| read().filter(|file| worst(file) == Some(severity)).count();
        let [with_errors, with_warnings] = [Severity::Error, Severity::Warning].map(count);
        Self {
            files: files.len(),
            failed: files.len() - read().count(),
            with_errors,
            with_warnings,
            healthy: read().count() - with_errors - with_warnings,
            errors: by_code(Severity::Error),
            warnings: by_code(Severity::Warning),
            infos: by_code(Severity::Info),
            not_checked: by_code(Severity::NotChecked),
        }
    }
}

/// The findings in one file, or the error that prevented reading it.
#[derive(Serialize)]
pub struct CheckedFile {
    pub input: String,
    pub error: Option<String>,
    pub map: Option<ReportedMap>,
    /// What importers of a format other than glTF make of the mistakes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub importer_note: Option<&'static str>,
    /// What happened, what it looks like and what to do; empty for a file that cannot be read.
    pub diagnosis: String,
    pub findings: Vec<ReportedFinding>,
    /// What was lost when a file of a format other than glTF was read, which no finding can name.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

/// The judgement on an image.
#[derive(Serialize)]
pub struct ReportedMap {
    pub verdict: &'static str,
    pub confidence: f32,
    pub correlation: f32,
    pub z_score: f32,
    pub by_model: Option<DirectionsByModel>,
}

/// Where red and green point, if the faces of the model decide that.
#[derive(Serialize)]
pub struct DirectionsByModel {
    pub red: &'static str,
    pub green: &'static str,
}

/// An edit that a repair would make.
#[derive(Serialize)]
pub struct ReportedEdit {
    /// The place in words.
    #[serde(skip)]
    pub place: String,
    pub mesh: Option<usize>,
    pub primitive: Option<usize>,
    pub image: Option<usize>,
    pub action: String,
}

impl ReportedEdit {
    /// The edit that repairs a finding about an image.
    pub fn of(finding: &Finding) -> Self {
        let action = format!("repair {}: {}", finding.code, finding.code.repair().unwrap_or_default());
        Self::at(&finding.place, action)
    }

    fn at(place: &Place, action: String) -> Self {
        let name = place.primitive.as_ref();
        Self {
            place: place.to_string(),
            mesh: name.map(|name| name.mesh),
            primitive: name.map(|name| name.primitive),
            image: place.image,
            action,
        }
    }
}

impl From<PlannedEdit> for ReportedEdit {
    fn from(edit: PlannedEdit) -> Self {
        Self::at(&edit.place, edit.action)
    }
}

impl ReportedMap {
    /// None for an image that cannot be decoded.
    pub fn of(checked: &CheckedMap) -> Option<Self> {
        let MapJudgement { verdict, confidence, correlation, z_score, .. } = checked.judgement?;
        let by_model = checked.directions.map(|MapDirections { red, green, .. }| DirectionsByModel {
            red: if red == TangentDirection::Right { "right" } else { "left" },
            green: if green == BitangentDirection::Up { "up" } else { "down" },
        });
        Some(Self { verdict: verdict.name(), confidence, correlation, z_score, by_model })
    }
}

//! [`ReportedFindings`]: the findings of a file, and words about all of it, for the command, Python and npm.

use darboux_io::gltf::Document;
use serde::Serialize;

use crate::check_options::CheckOptions;
use crate::diagnosis::diagnosis;
use crate::report::ReportedFinding;
use crate::severity::Severity;

/// The findings of a file, and words about all of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ReportedFindings {
    /// The findings.
    pub findings: Vec<ReportedFinding>,
    /// What happened, what it looks like and what to do, in one to three sentences, and what was expected of
    /// normal maps if it is not glTF's convention.
    pub diagnosis: String,
    /// What importers of a format other than glTF make of the mistakes; none without mistakes.
    pub importer_note: Option<&'static str>,
    /// What was lost when a file of a format other than glTF was read, one sentence each.
    pub warnings: Vec<String>,
}

impl ReportedFindings {
    /// Of findings before or after a repair. `document`: the model; none for a map. `options`: those of the
    /// check.
    pub fn new<F: Into<ReportedFinding>>(
        findings: impl IntoIterator<Item = F>,
        document: Option<&Document>,
        options: &CheckOptions,
    ) -> Self {
        let mut findings: Vec<ReportedFinding> = findings.into_iter().map(Into::into).collect();
        let source = document.and_then(|document| Some((document.provenance()?, document.warnings())));
        let Some((provenance, warnings)) = source else {
            return Self { diagnosis: diagnosis(&findings, options), findings, ..Self::default() };
        };
        findings.iter_mut().for_each(|finding| finding.name_place(provenance));
        let is_mistake = |finding: &ReportedFinding| finding.severity >= Severity::Warning;
        Self {
            diagnosis: diagnosis(&findings, options),
            importer_note: provenance.format.importer_note().filter(|_| findings.iter().any(is_mistake)),
            warnings: warnings.to_vec(),
            findings,
        }
    }
}

//! What all parts of the page use.

use darboux_check::Severity;

use super::super::report::CheckedFile;

/// The worst severity in a file; none without findings.
pub fn worst(file: &CheckedFile) -> Option<Severity> {
    file.findings.iter().map(|finding| finding.severity).max()
}

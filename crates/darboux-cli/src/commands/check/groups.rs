//! Findings in the order in which they are read, and by kind.

use std::cmp::Reverse;

use darboux_check::ReportedFinding;

/// The errors first, then warnings, then what is worth knowing; causes before what follows from them.
pub fn by_severity(findings: &[ReportedFinding]) -> Vec<&ReportedFinding> {
    let mut sorted: Vec<&ReportedFinding> = findings.iter().collect();
    sorted.sort_by_key(|finding| Reverse(finding.severity));
    sorted
}

/// The findings of one severity and code together, in the order of [`by_severity`].
pub fn by_kind(findings: &[ReportedFinding]) -> Vec<Vec<&ReportedFinding>> {
    let mut groups: Vec<Vec<&ReportedFinding>> = Vec::new();
    for finding in by_severity(findings) {
        let is_same =
            |other: &ReportedFinding| (other.severity, other.code) == (finding.severity, finding.code);
        match groups.iter_mut().find(|group| is_same(group[0])) {
            Some(group) => group.push(finding),
            None => groups.push(vec![finding]),
        }
    }
    groups
}

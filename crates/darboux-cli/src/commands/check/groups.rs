//! Findings in the order in which they are read, by kind and by what they say.

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
    grouped(findings, |a, b| (a.severity, a.code) == (b.severity, b.code))
}

/// The findings that say the same together, in the order of [`by_severity`].
pub fn by_statement(findings: &[ReportedFinding]) -> Vec<Vec<&ReportedFinding>> {
    grouped(findings, ReportedFinding::says_the_same)
}

fn grouped(
    findings: &[ReportedFinding],
    is_same: impl Fn(&ReportedFinding, &ReportedFinding) -> bool,
) -> Vec<Vec<&ReportedFinding>> {
    let mut groups: Vec<Vec<&ReportedFinding>> = Vec::new();
    for finding in by_severity(findings) {
        match groups.iter_mut().find(|group| is_same(group[0], finding)) {
            Some(group) => group.push(finding),
            None => groups.push(vec![finding]),
        }
    }
    groups
}

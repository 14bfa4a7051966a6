//! Findings in the order in which they are read, by kind and by what they say.

use std::cmp::Reverse;

use darboux_check::{ReportedFinding, statements};

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
        let is_same = |group: &&mut Vec<&ReportedFinding>| {
            (group[0].severity, group[0].code) == (finding.severity, finding.code)
        };
        match groups.iter_mut().find(is_same) {
            Some(group) => group.push(finding),
            None => groups.push(vec![finding]),
        }
    }
    groups
}

/// The findings that say the same together, in the order of [`by_severity`].
pub fn by_statement(findings: &[ReportedFinding]) -> Vec<Vec<&ReportedFinding>> {
    let of = |numbers: Vec<usize>| numbers.into_iter().map(|number| &findings[number]).collect();
    statements(findings).into_iter().map(of).collect()
}

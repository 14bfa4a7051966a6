//! `darboux check`: what it finds, what it prints and what it repairs.

#[path = "../common/mod.rs"]
mod common;
mod folders;
mod maps;
mod repairs;
mod reports;

/// The codes of a report's findings that fulfil a condition.
pub fn codes(report: &serde_json::Value, condition: impl Fn(&serde_json::Value) -> bool) -> Vec<String> {
    let findings = report["files"][0]["findings"].as_array().expect("a list").iter();
    let code = |finding: &serde_json::Value| finding["code"].as_str().unwrap_or_default().to_owned();
    findings.filter(|finding| condition(finding)).map(code).collect()
}

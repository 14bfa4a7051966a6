//! The findings as text, grouped by place, and the section of a code.

use std::cmp::Reverse;

use darboux_check::{Code, Evidence, ReportedFinding, Severity};
use darboux_io::words::{Count, Sure, listed};

use super::arguments::FailOn;
use super::groups::{by_kind, by_severity, by_statement};
use super::report::{CheckReport, CheckTotals, CheckedFile, DirectionsByModel, ReportedMap};
use crate::text::{counted, printable, shell_word};

/// The findings in a file, each at its place.
pub fn describe(file: &CheckedFile) -> String {
    let mut text = head(file);
    let mut places: Vec<(&str, Vec<&ReportedFinding>)> = Vec::new();
    for finding in by_severity(&file.findings) {
        match places.iter_mut().find(|(place, _)| *place == finding.place) {
            Some((_, findings)) => findings.push(finding),
            None => places.push((&finding.place, vec![finding])),
        }
    }
    for (place, findings) in places {
        text += &format!("  {}\n", printable(place));
        text.extend(findings.into_iter().map(|finding| lines(&[finding], file)));
    }
    text + &counts(file)
}

/// The findings in a file by severity and code, with the first places of each, and what is worth knowing in
/// one line.
pub fn describe_folded(file: &CheckedFile) -> String {
    let mut text = head(file);
    for group in by_statement(&file.findings).into_iter().filter(|group| group[0].severity > Severity::Info) {
        let places: Vec<&str> = group.iter().map(|finding| &*finding.place).collect();
        text += &format!("  {}\n{}", printable(&listed(&places)), lines(&group, file));
    }
    let known = by_kind(&file.findings).into_iter().filter(|group| group[0].severity <= Severity::Info);
    let (unchecked, known): (Vec<_>, Vec<_>) =
        known.partition(|group| group[0].severity == Severity::NotChecked);
    for finding in unchecked.into_iter().flatten().take(MOST_UNCHECKED) {
        text += &format!("  not checked: {}: {}\n", printable(&finding.place), printable(&finding.text));
    }
    if !known.is_empty() {
        let codes = known.iter().map(|group| with_count(group));
        text += &format!("  worth knowing (-v): {}\n", codes.collect::<Vec<_>>().join(", "));
    }
    text + &counts(file)
}

/// The most maps that were not checked of which the reason is printed.
const MOST_UNCHECKED: usize = 5;

/// What follows the total where files were described in one line each.
pub const HOW_TO_SEE_MORE: &str =
    "  -v prints what each of these means, what it looks like and what to type\n";

/// A file in one line, with the codes of its errors, its warnings and what was not checked; nothing for a
/// model without any.
pub fn describe_briefly(file: &CheckedFile) -> String {
    let groups = by_kind(&file.findings);
    let of_severity = |severity: Severity, one: &str, more: &str| {
        let groups: Vec<_> = groups.iter().filter(|group| group[0].severity == severity).collect();
        let count = groups.iter().map(|group| group.len()).sum();
        let codes: Vec<String> = groups.into_iter().map(|group| with_count(group)).collect();
        (count > 0).then(|| format!("{} ({})", counted(count, one, more), codes.join(", ")))
    };
    let verdict = file.map.as_ref().map(verdict);
    let errors = of_severity(Severity::Error, "error", "errors");
    let warnings = of_severity(Severity::Warning, "warning", "warnings");
    let unchecked = of_severity(Severity::NotChecked, "map not checked", "maps not checked");
    let parts: Vec<String> = verdict.into_iter().chain(errors).chain(warnings).chain(unchecked).collect();
    if parts.is_empty() {
        String::new()
    } else {
        format!("{}: {}\n", printable(&file.input), parts.join(", "))
    }
}

/// The code of some findings of one kind, with their number if there are several.
fn with_count(group: &[&ReportedFinding]) -> String {
    match group.len() {
        1 => group[0].code.to_string(),
        count => format!("{} ({})", group[0].code, Count(count)),
    }
}

/// The name of a file, the diagnosis and the verdict on an image.
fn head(file: &CheckedFile) -> String {
    let diagnosis = with_file_name(&file.diagnosis, file);
    let mut text = format!("{}\n  {}\n", printable(&file.input), printable(&diagnosis));
    if !file.warnings.is_empty() {
        text += "  The warnings say what was lost when it was read.\n";
    }
    text.extend(file.importer_note.map(|note| format!("  {note}\n")));
    if let Some(map) = &file.map {
        text += &format!("  {}\n", verdict(map));
    }
    text
}

/// Words with the file's name in the commands that they tell, so that these can be typed as they stand.
pub fn with_file_name(words: &str, file: &CheckedFile) -> String {
    words.replace("darboux check FILE", &format!("darboux check {}", shell_word(&file.input)))
}

/// The number of findings by severity.
fn counts(file: &CheckedFile) -> String {
    let count = |severity| file.findings.iter().filter(|finding| finding.severity == severity).count();
    let [errors, warnings, infos] = [Severity::Error, Severity::Warning, Severity::Info].map(count);
    let errors = counted(errors, "error", "errors");
    let warnings = counted(warnings, "warning", "warnings");
    let not_checked = match count(Severity::NotChecked) {
        0 => String::new(),
        count => format!(", {} not checked", counted(count, "map", "maps")),
    };
    format!("  {errors}, {warnings}, {} worth knowing{not_checked}\n", counted(infos, "thing", "things"))
}

/// What was found in all files, by code.
pub fn total(report: &CheckReport) -> String {
    let CheckTotals { files, failed, with_errors, with_warnings, healthy, .. } = &report.totals;
    let mut text = format!(
        "{}: {with_errors} with errors, {with_warnings} with warnings only, {healthy} without",
        counted(*files, "file", "files")
    );
    if *failed > 0 {
        text += &format!(", {} that cannot be read", Count(failed));
    }
    let CheckTotals { errors, warnings, not_checked, .. } = &report.totals;
    let of_severities = [
        (Severity::Error, "error", errors),
        (Severity::Warning, "warning", warnings),
        (Severity::NotChecked, "not-checked", not_checked),
    ];
    for (severity, name, codes) in of_severities {
        let mut codes: Vec<_> = codes.iter().collect();
        codes.sort_by_key(|(_, count)| Reverse(**count));
        text.extend(codes.into_iter().map(|(code, count)| {
            let has = |finding: &ReportedFinding| (finding.severity, finding.code) == (severity, *code);
            let files = report.files.iter().filter(|file| file.findings.iter().any(has)).count();
            let files = counted(files, "file", "files");
            format!("\n  {name:11} {code} {} in {files}", Count(count))
        }));
    }
    text + "\n"
}

/// The errors in a file and what else makes the exit code 1, one line each.
pub fn failures(file: &CheckedFile, fail_on: FailOn) -> String {
    let is_failure = |severity: Severity| severity == Severity::Error || fail_on.includes(severity);
    let failures = file.findings.iter().filter(|finding| is_failure(finding.severity));
    let line = |finding: &ReportedFinding| {
        let line = format!("{}: {}: {}: {}", file.input, finding.place, finding.code, finding.text);
        format!("{}\n", printable(&line))
    };
    failures.map(line).collect()
}

/// The verdict on an image as a clause.
pub fn verdict(map: &ReportedMap) -> String {
    let sure = Sure(map.confidence.into());
    if let Some(DirectionsByModel { red, green }) = map.by_model {
        let convention = if green == "up" { "OpenGL" } else { "DirectX" };
        let red = if red == "left" { " and red is inverted" } else { "" };
        return format!("green points {green} ({convention}){red}, by the texels and the faces of the model");
    }
    match map.verdict {
        "opengl" => format!("green points up (OpenGL), {sure} sure"),
        "directx" => format!("green points down (DirectX) or red is inverted, {sure} sure"),
        "flat" => "all its texels have one colour".to_owned(),
        "no_gradient" => {
            "red and green are not the slopes of a surface, as those of a normal map in tangent space are"
                .to_owned()
        }
        _ => format!(
            "whether green points up or down cannot be told from the texels: {}",
            undecided(map.z_score)
        ),
    }
}

/// Why there is no verdict.
fn undecided(z_score: f32) -> &'static str {
    match z_score.abs() {
        0.0 => "too few of them belong to a surface with slopes",
        ..4.0 => "their slopes do not stand out from rounding and noise",
        _ => "the map and its reduced sizes contradict each other, as where details are finer than a texel",
    }
}

/// Findings that say the same, with the numbers of the first.
fn lines(group: &[&ReportedFinding], file: &CheckedFile) -> String {
    let finding = group[0];
    let mut text = format!("    {:7} {}: {}\n", finding.severity, finding.code, printable(&finding.text));
    let evidence: Vec<String> = finding.evidence.iter().map(number).collect();
    if !evidence.is_empty() {
        let of_first = if group.len() > 1 { " of the first" } else { "" };
        text += &format!("            evidence{of_first}: {}\n", evidence.join("; "));
    }
    let ReportedFinding { looks_like, cure, .. } = finding;
    if finding.severity > Severity::Info {
        text += &format!("            looks like: {looks_like}\n");
    }
    text += &format!("            cure: {}\n", printable(&with_file_name(cure, file)));
    match &finding.left_because {
        None => text += "            --fix repairs it\n",
        Some(reason) if finding.severity > Severity::Info => {
            text += &format!("            --fix leaves it: {reason}\n")
        }
        Some(_) => {}
    }
    text
}

/// A number with its name and unit.
pub fn number(evidence: &Evidence) -> String {
    let Evidence { what, value, unit, .. } = evidence;
    let space = if unit.is_empty() { "" } else { " " };
    format!("{what} {}{space}{unit}", decimals(*value))
}

/// A number with at most three decimals, or as many as it takes to show that it is not zero.
fn decimals(value: f64) -> String {
    const MOST: usize = 9;
    if value.fract() == 0.0 {
        return format!("{value}");
    }
    let written = |digits: usize| format!("{value:.digits$}");
    let is_shown =
        |digits: &usize| written(*digits).contains(|digit: char| digit.is_ascii_digit() && digit != '0');
    let written = written((3..=MOST).find(is_shown).unwrap_or(MOST));
    written.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The section of a code.
pub fn explain(code: Code) -> String {
    format!(
        "{code} ({})\n\n{}\n\nWhat it looks like: {}\n\nHow it comes about: {}\n\nCure: {}\n\nWith --fix: \
         {}.\n",
        code.severity(),
        code.meaning(),
        code.looks_like(),
        code.cause(),
        code.cure(),
        with_fix(code)
    )
}

/// What `--fix` does with findings of a code, as a clause.
fn with_fix(code: Code) -> String {
    match (code.repair(), code.left_because()) {
        (Some(repair), _) => repair.to_owned(),
        (None, reason) => format!("left, because {}", reason.unwrap_or_default()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_are_not_written_as_zero() {
        let written = [0.0, 3.0, 12.3456, 0.0004, 0.000_021, -0.000_04, 99.9].map(decimals);
        assert_eq!(written, ["0", "3", "12.346", "0.0004", "0.00002", "-0.00004", "99.9"]);
    }
}

//! What all parts of the page use.

use darboux_check::Severity;

use super::super::report::CheckedFile;

/// The worst severity in a file; none without findings.
pub fn worst(file: &CheckedFile) -> Option<Severity> {
    file.findings.iter().map(|finding| finding.severity).max()
}

/// A text in HTML.
pub fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            letter if letter.is_control() => safe += " ",
            letter => safe.push(letter),
        }
    }
    safe
}

//! The part of the page about one file.

use darboux_check::{ReportedFinding, Severity};
use darboux_io::words::Count;

use super::super::groups::by_statement;
use super::super::report::CheckedFile;
use super::super::text;
use super::pictures::{Pair, Pictures};
use super::shared::worst;
use crate::html_page::{escaped, with_code};
use crate::text::counted;

/// The number of places of a kind of finding that are written in full.
const PLACES: usize = 50;

/// The class and the words for what a file has.
pub fn verdict(file: &CheckedFile) -> (&'static str, &'static str) {
    match (&file.error, worst(file)) {
        (Some(_), _) => ("error", "✕ cannot be read"),
        (None, Some(Severity::Error)) => ("error", "✕ errors"),
        (None, Some(Severity::Warning)) => ("warning", "△ warnings"),
        (None, Some(Severity::NotChecked)) => ("warning", "△ not checked"),
        (None, _) => ("healthy", "✓ nothing is wrong"),
    }
}

/// The section of a file: diagnosis, pictures, findings by kind, and notes.
pub fn section(number: usize, file: &CheckedFile, pictures: Pictures) -> String {
    let (class, word) = verdict(file);
    let name = escaped(&file.input);
    let mut html = format!(
        "<section id=\"file-{number}\" class=\"file {class}\" aria-labelledby=\"name-{number}\">\n<h2 \
         id=\"name-{number}\">{name} <span class=\"verdict\">{word}</span></h2>\n"
    );
    match &file.error {
        Some(error) => html += &format!("<p class=\"diagnosis\">{}</p>\n", escaped(error)),
        None => {
            html += &format!(
                "<p class=\"diagnosis\">{}</p>\n",
                with_code(&text::with_file_name(&file.diagnosis, file))
            )
        }
    }
    if let Some(map) = &file.map {
        html += &format!("<p>The map: {}.</p>\n", escaped(&text::verdict(map)));
    }
    html += &of_pictures(pictures);
    let (notes, severe): (Vec<_>, Vec<_>) =
        by_statement(&file.findings).into_iter().partition(|group| group[0].severity <= Severity::Info);
    html.extend(severe.iter().map(|group| card(group, file)));
    if !notes.is_empty() {
        let count = notes.iter().map(Vec::len).sum();
        let cards: String = notes.iter().map(|group| card(group, file)).collect();
        let summary = counted(count, "thing worth knowing", "things worth knowing");
        html += &format!("<details><summary>{summary}</summary>\n{cards}</details>\n");
    }
    html + "</section>\n"
}

/// The pictures, or why there are none.
fn of_pictures(pictures: Pictures) -> String {
    match pictures {
        Pictures::None(None) => String::new(),
        Pictures::None(Some(reason)) => format!("<p class=\"faint\">{}</p>\n", escaped(&reason)),
        Pictures::One { png, size, why } => {
            let [width, height] = size;
            format!(
                "<figure><img src=\"{png}\" width=\"{width}\" height=\"{height}\" alt=\"The model as it is \
                 in the file\"><figcaption>{}</figcaption></figure>\n",
                escaped(&why)
            )
        }
        Pictures::Pairs(pairs) => {
            let pairs: String = pairs.iter().map(pair).collect();
            format!("<div class=\"pairs\">\n{pairs}</div>\n")
        }
    }
}

/// Two pictures over each other with a slider, and beside each other where no script runs.
fn pair(Pair { caption, before, after, size: [width, height], split }: &Pair) -> String {
    let caption = escaped(caption);
    format!(
        "<figure class=\"pair\">\n<div class=\"frame\">\n<div class=\"before\"><img src=\"{before}\" \
         width=\"{width}\" height=\"{height}\" alt=\"{caption}, in the file\"><p>In the file</p></div>\n\
        <div class=\"after\"><img src=\"{after}\" width=\"{width}\" height=\"{height}\" alt=\"{caption}, \
        repaired\"><p>Repaired</p></div>\n\
        <input type=\"range\" min=\"0\" max=\"100\" value=\"{split}\" aria-label=\"{caption}: percent of the \
        picture that shows the file\" hidden>\n</div>\n<figcaption>{caption}</figcaption>\n</figure>\n"
    )
}

/// One kind of finding with all its places.
fn card(group: &[&ReportedFinding], file: &CheckedFile) -> String {
    let ReportedFinding { code, severity, looks_like, .. } = group[0];
    let (class, word) = match severity {
        Severity::Error => ("error", "✕ Error"),
        Severity::Warning => ("warning", "△ Warning"),
        Severity::NotChecked => ("warning", "△ Not checked"),
        _ => ("note", "ⓘ Note"),
    };
    let mut html = format!(
        "<article class=\"{class}\">\n<h3><span class=\"severity\">{word}</span> <code>{code}</code></h3>\n{}",
        place(group[0])
    );
    if *severity > Severity::Info {
        html += &format!("<p><b>Looks like:</b> {}</p>\n", escaped(looks_like));
    }
    let cure = with_code(&text::with_file_name(&group[0].cure, file));
    html += &format!("<p><b>Cure:</b> {cure}</p>\n<p>{}</p>\n", with_fix(group));
    if group.len() > 1 {
        let more: String = group[1..].iter().take(PLACES).map(|finding| place(finding)).collect();
        let rest = match group.len().saturating_sub(1 + PLACES) {
            0 => String::new(),
            count => format!(
                "<p>and {} more: <code>darboux check -v</code> prints all of them.</p>\n",
                Count(count)
            ),
        };
        let summary = counted(group.len() - 1, "more place", "more places");
        html += &format!("<details><summary>{summary}</summary>\n{more}{rest}</details>\n");
    }
    html + "</article>\n"
}

/// A finding at its place, with its numbers.
fn place(finding: &ReportedFinding) -> String {
    let numbers: Vec<String> = finding.evidence.iter().map(text::number).collect();
    let numbers = match numbers.is_empty() {
        true => String::new(),
        false => format!(" <span class=\"faint\">({})</span>", escaped(&numbers.join("; "))),
    };
    format!("<p><b>{}</b>: {}{numbers}</p>\n", escaped(&finding.place), escaped(&finding.text))
}

/// What `--fix` does with findings of a kind.
fn with_fix(group: &[&ReportedFinding]) -> String {
    let fixable = group.iter().filter(|finding| finding.fixable).count();
    match (fixable, group.iter().find_map(|finding| finding.left_because.as_deref())) {
        (0, Some(reason)) => format!("<code>--fix</code> leaves it: {}", escaped(reason)),
        (fixable, Some(reason)) => {
            format!(
                "<code>--fix</code> repairs {} of {} places; it leaves others: {}",
                Count(fixable),
                Count(group.len()),
                escaped(reason)
            )
        }
        (_, None) => "<code>--fix</code> repairs it.".to_owned(),
    }
}

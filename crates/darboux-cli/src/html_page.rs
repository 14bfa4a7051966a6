//! The frame of the pages that `darboux report` and `darboux bake --report` write: one HTML file that loads
//! nothing.

#[cfg(feature = "gpu")]
pub mod drawing;
mod html_text;
#[cfg(any(feature = "bake", feature = "gpu"))]
pub mod raster;

use std::path::Path;

use crate::json::VERSION;
use crate::paths::refuse_missing_folder;

pub use html_text::{escaped, with_code};

const STYLE: &str = include_str!("html_page/page.css");

/// A page. The parts are HTML, unless they are called text.
pub struct HtmlPage<'a> {
    /// Text.
    pub title: &'a str,
    /// Text: one paragraph below the title.
    pub summary: &'a str,
    /// Before the main part; may be empty.
    pub contents: String,
    pub main: String,
    /// The CSS rules of this page, beside the rules of all pages.
    pub style: &'a str,
    /// What the page runs; empty if it needs no script.
    pub script: &'a str,
}

impl HtmlPage<'_> {
    /// The file.
    pub fn text(&self) -> String {
        let Self { contents, main, style, script, .. } = self;
        let [title, summary] = [self.title, self.summary].map(escaped);
        let (allowed, script) = match script.is_empty() {
            true => ("", String::new()),
            false => ("; script-src 'unsafe-inline'", format!("<script>\n{script}</script>\n")),
        };
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
            <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
            <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; \
            style-src 'unsafe-inline'{allowed}\">\n\
            <title>{title}</title>\n<style>\n{STYLE}{style}</style>\n</head>\n<body>\n<header>\n<h1>{title}</h1>\n<p>{summary}</p>\n</header>\n\
            {contents}<main>\n{main}</main>\n<footer><p>Written by darboux {VERSION}. This file is complete: \
            it loads nothing.</p></footer>\n\
            {script}</body>\n</html>\n"
        )
    }
}

/// Refuses a path that cannot be a page's: another ending, or a folder that does not exist. The error is one
/// sentence.
pub fn refuse_no_page(path: &Path) -> Result<(), String> {
    refuse_other_ending(path)?;
    refuse_missing_folder(path)
}

/// Refuses a name that is no page's. The error is one sentence.
pub fn refuse_other_ending(path: &Path) -> Result<(), String> {
    let is_html = path
        .extension()
        .is_some_and(|extension| ["html", "htm"].iter().any(|name| extension.eq_ignore_ascii_case(name)));
    match is_html {
        true => Ok(()),
        false => Err(format!("{}: the report is a page; its name must end in .html", path.display())),
    }
}

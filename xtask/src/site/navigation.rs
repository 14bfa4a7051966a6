//! The frame of every page: menu, search field, and the page itself.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::html::{Page, escaped, target};

/// The parts of the menu with their pages in order. All other pages follow in the last part.
const PARTS: [(&str, &[&str]); 4] = [
    (
        "Start",
        &[
            "README.md",
            "docs/learn/symptoms.md",
            "docs/matching-your-baker.md",
            "docs/algorithms/mistakes.md",
            "docs/check.md",
            "docs/viewer.md",
        ],
    ),
    (
        "Learn",
        &[
            "docs/learn/README.md",
            "docs/learn/1-why-a-frame.md",
            "docs/learn/2-two-derivatives.md",
            "docs/learn/3-averaging.md",
            "docs/learn/4-perpendicular.md",
            "docs/learn/5-mirrored.md",
            "docs/learn/6-weights.md",
            "docs/learn/7-mikktspace.md",
            "docs/learn/8-shaders.md",
            "docs/learn/9-moving.md",
            "docs/learn/10-parallel.md",
            "docs/learn/beyond.md",
            "docs/learn/questions.md",
            "docs/learn/glossary.md",
        ],
    ),
    (
        "Use",
        &[
            "docs/cli.md",
            "docs/functions.md",
            "docs/rust.md",
            "docs/io.md",
            "docs/c.md",
            "docs/python.md",
            "bindings/js/README.md",
            "docs/gpu.md",
            "docs/shaders.md",
            "docs/render.md",
            "docs/bake.md",
            "docs/security.md",
        ],
    ),
    (
        "Understand",
        &[
            "docs/conventions.md",
            "docs/algorithms/mikktspace.md",
            "docs/algorithms/methods.md",
            "docs/algorithms/gpu.md",
            "docs/conformance.md",
            "conformance/README.md",
        ],
    ),
];

/// The frame of a page, with names in braces for what differs.
const TEMPLATE: &str = include_str!("../../../site/page.html");

/// Loads the interactive figures.
const FIGURES: &str = "<script type=\"module\" src=\"{base}figures.js\"></script>\n";

/// The menu: parts with the paths and titles of their pages.
pub struct Menu {
    parts: Vec<(&'static str, Vec<(PathBuf, String)>)>,
}

impl Menu {
    pub fn new(pages: &BTreeMap<PathBuf, Page>) -> Self {
        let entry = |path: &Path| Some((path.to_path_buf(), pages.get(path)?.title.clone()));
        let mut parts: Vec<_> = PARTS
            .map(|(title, paths)| {
                (title, paths.iter().filter_map(|path| entry(Path::new(path))).collect::<Vec<_>>())
            })
            .into();
        let is_listed =
            |path: &Path| PARTS.iter().any(|(_, paths)| paths.iter().any(|listed| Path::new(listed) == path));
        parts.push((
            "More",
            pages.keys().filter(|path| !is_listed(path)).filter_map(|path| entry(path)).collect(),
        ));
        Self { parts }
    }

    /// The whole HTML document of a page.
    pub fn document(&self, path: &Path, page: &Page) -> String {
        let base = "../".repeat(path.components().count() - 1);
        let menu: String = self.parts.iter().map(|(name, pages)| part(name, pages, path, &base)).collect();
        let figures = if page.body.contains("class=\"interactive\"") { FIGURES } else { "" };
        // The body comes last: it may contain the names of the other parts.
        TEMPLATE
            .replace("{figures}", figures)
            .replace("{base}", &base)
            .replace("{title}", &escaped(&page.title))
            .replace("{menu}", &menu)
            .replacen("{body}", &page.body, 1)
    }
}

fn part(name: &str, pages: &[(PathBuf, String)], current: &Path, base: &str) -> String {
    let item = |(path, title): &(PathBuf, String)| {
        let mark = if path == current { " aria-current=\"page\"" } else { "" };
        format!("<li><a href=\"{base}{}\"{mark}>{}</a></li>", target(path).display(), escaped(title))
    };
    let items: String = pages.iter().map(item).collect();
    format!("<h2>{name}</h2><ul>{items}</ul>")
}

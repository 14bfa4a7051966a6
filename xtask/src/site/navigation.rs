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
            "docs/formats.md",
            "docs/c.md",
            "docs/python.md",
            "bindings/js/README.md",
            "docs/gpu.md",
            "docs/shaders.md",
            "docs/render.md",
            "docs/report.md",
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
        let turn = self.turn(path, &base);
        let figures = if page.body.contains("class=\"interactive\"") { FIGURES } else { "" };
        // The body comes last: it may contain the names of the other parts.
        TEMPLATE
            .replace("{figures}", figures)
            .replace("{base}", &base)
            .replace("{title}", &escaped(&page.title))
            .replace("{version}", env!("CARGO_PKG_VERSION"))
            .replace("{repository}", &repository())
            .replace("{menu}", &menu)
            .replace("{contents}", &contents(&page.body))
            .replace("{turn}", &turn)
            .replacen("{body}", &page.body, 1)
    }

    /// Links to the pages before and after a page in the menu.
    fn turn(&self, path: &Path, base: &str) -> String {
        let all: Vec<_> = self.parts.iter().flat_map(|(_, pages)| pages).collect();
        let Some(at) = all.iter().position(|(other, _)| other == path) else { return String::new() };
        let link = |way: &str, entry: Option<&&(PathBuf, String)>| {
            entry.map_or(String::new(), |(path, title)| {
                format!("<a href=\"{base}{}\">{way}: {}</a>", target(path).display(), escaped(title))
            })
        };
        let before = at.checked_sub(1).and_then(|before| all.get(before));
        let [before, after] = [link("Previous", before), link("Next", all.get(at + 1))];
        format!("<nav class=\"turn\" aria-label=\"Pages before and after\">{before}{after}</nav>\n")
    }
}

/// The address of the repository in the workspace's manifest, as a link; empty while there is none.
fn repository() -> String {
    match env!("CARGO_PKG_REPOSITORY") {
        "" => String::new(),
        address => format!("<a href=\"{}\">Repository</a> ", escaped(address)),
    }
}

/// A page with fewer headings has no list of them.
const LEAST_HEADINGS: usize = 6;

/// The headings of level 2 of a long page as links.
fn contents(body: &str) -> String {
    let heading = |part: &str| {
        let (id, rest) = part.split_once('"')?;
        let (title, _) = rest.split_once('>')?.1.split_once("</h2>")?;
        Some(format!("<li><a href=\"#{id}\">{}</a></li>", without_tags(title)))
    };
    let items: Vec<String> = body.split("<h2 id=\"").skip(1).filter_map(heading).collect();
    if items.len() < LEAST_HEADINGS {
        return String::new();
    }
    format!(
        "<details class=\"contents\"><summary>On this page</summary><nav aria-label=\"On this \
         page\"><ul>{}</ul></nav></details>\n",
        items.concat()
    )
}

/// HTML without its tags.
fn without_tags(html: &str) -> String {
    let mut text = String::new();
    let mut is_tag = false;
    for letter in html.chars() {
        match letter {
            '<' => is_tag = true,
            '>' => is_tag = false,
            letter if !is_tag => text.push(letter),
            _ => {}
        }
    }
    text
}

fn part(name: &str, pages: &[(PathBuf, String)], current: &Path, base: &str) -> String {
    let item = |(path, title): &(PathBuf, String)| {
        let mark = if path == current { " aria-current=\"page\"" } else { "" };
        format!("<li><a href=\"{base}{}\"{mark}>{}</a></li>", target(path).display(), escaped(title))
    };
    let items: String = pages.iter().map(item).collect();
    format!("<h2>{name}</h2><ul>{items}</ul>")
}

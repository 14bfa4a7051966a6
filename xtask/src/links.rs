//! `cargo xtask links`: links between the pages of the repository lead to files and headings that exist, and every page has a title.
//!
//! Links to other sites are not followed, so that the check needs no network.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use pulldown_cmark::{Event, HeadingLevel, Options, Parser, Tag, TagEnd};

use crate::run::{Outcome, output_of, program, root};

/// What a page offers to links, and where its own links lead.
struct Page {
    /// The identifiers of its headings, as GitHub makes them.
    headings: BTreeSet<String>,
    /// The targets of its links and images as they are written.
    links: Vec<String>,
    /// True if its first heading is of level 1 and has a text.
    has_title: bool,
}

/// Errors: links that lead nowhere, each with its page; pages without a title.
pub fn check() -> Outcome {
    let pages = pages()?;
    let mut dead = Vec::new();
    let mut count = 0;
    for (path, page) in &pages {
        for link in page.links.iter().filter(|link| !is_elsewhere(link)) {
            count += 1;
            if let Some(reason) = problem(path, link, &pages) {
                dead.push(format!("{}: {link}: {reason}", path.display()));
            }
        }
    }
    if !dead.is_empty() {
        return Err(format!("{} links lead nowhere:\n{}", dead.len(), dead.join("\n")));
    }
    require_titles(&pages)?;
    println!("{count} links of {} pages lead to something", pages.len());
    Ok(())
}

/// Errors: pages without a title. The site has a page of every Markdown file, and its menu shows their titles.
fn require_titles(pages: &BTreeMap<PathBuf, Page>) -> Outcome {
    let untitled = pages.iter().filter(|(_, page)| !page.has_title);
    let untitled: Vec<String> = untitled.map(|(path, _)| path.display().to_string()).collect();
    if untitled.is_empty() {
        return Ok(());
    }
    Err(format!(
        "these pages do not begin with a heading of level 1 (a part of another page is a .txt file): {}",
        untitled.join(", ")
    ))
}

/// The paths of all Markdown files that git knows or would add.
pub fn page_paths() -> Result<Vec<PathBuf>, String> {
    let listed = output_of(&mut program("git ls-files --cached --others --exclude-standard *.md"))?;
    let listed = String::from_utf8_lossy(&listed);
    Ok(listed.lines().filter(|name| root().join(name).is_file()).map(PathBuf::from).collect())
}

fn pages() -> Result<BTreeMap<PathBuf, Page>, String> {
    let read = |path: PathBuf| {
        let text = fs::read_to_string(root().join(&path));
        let text = text.map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
        Ok((path, parse(&text)))
    };
    page_paths()?.into_iter().map(read).collect()
}

fn parse(text: &str) -> Page {
    let mut page = Page { headings: BTreeSet::new(), links: Vec::new(), has_title: false };
    let mut heading: Option<String> = None;
    for event in Parser::new_ext(text, Options::ENABLE_TABLES) {
        match event {
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                page.links.push(dest_url.into_string());
            }
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::End(TagEnd::Heading(level)) => {
                let name = identifier(&heading.take().unwrap_or_default());
                if page.headings.is_empty() {
                    page.has_title = level == HeadingLevel::H1 && !name.is_empty();
                }
                let same = page.headings.iter().filter(|other| is_numbered(other, &name)).count();
                page.headings.insert(if same == 0 { name } else { format!("{name}-{same}") });
            }
            Event::Text(words) | Event::Code(words) => {
                if let Some(heading) = &mut heading {
                    heading.push_str(&words);
                }
            }
            _ => {}
        }
    }
    page
}

/// True if `other` is `name`, or `name` with the number that tells equal headings of a page apart.
fn is_numbered(other: &str, name: &str) -> bool {
    let rest = other.strip_prefix(name).map(|rest| rest.strip_prefix('-').unwrap_or(rest));
    rest.is_some_and(|rest| rest.chars().all(|letter| letter.is_ascii_digit()))
}

/// The identifier that GitHub gives a heading: lower case, spaces as hyphens, no other punctuation.
pub fn identifier(heading: &str) -> String {
    let kept = |letter: &char| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_');
    heading
        .to_lowercase()
        .chars()
        .filter(kept)
        .map(|letter| if letter == ' ' { '-' } else { letter })
        .collect()
}

pub fn is_elsewhere(link: &str) -> bool {
    link.contains("://") || link.starts_with("mailto:")
}

/// Why a link of `page` leads nowhere; none if it leads somewhere.
fn problem(page: &Path, link: &str, pages: &BTreeMap<PathBuf, Page>) -> Option<String> {
    let (file, heading) = link.split_once('#').map_or((link, None), |(file, heading)| (file, Some(heading)));
    let folder = page.parent().unwrap_or(Path::new(""));
    let target = if file.is_empty() { page.to_path_buf() } else { without_dots(&folder.join(file)) };
    if !root().join(&target).exists() {
        return Some("there is no such file".into());
    }
    let heading = heading.filter(|_| pages.contains_key(&target))?;
    let is_there = pages[&target].headings.contains(heading);
    (!is_there).then(|| format!("{} has no such heading", target.display()))
}

/// The path with `..` resolved by its words alone.
pub fn without_dots(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            Component::CurDir => {}
            other => plain.push(other),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_and_links_are_found() {
        let page =
            parse("# A b\n[x](c.md#d) ![y](e.png)\n## A b\n\n`# no [z](f)`\n## The `code`, and more\n");
        assert_eq!(page.links, ["c.md#d", "e.png"]);
        assert_eq!(page.headings, ["a-b", "a-b-1", "the-code-and-more"].map(String::from).into());
    }

    #[test]
    fn pages_without_a_title_are_named() {
        let titled = BTreeMap::from([(PathBuf::from("a.md"), parse("text\n# A\n## B\n"))]);
        assert_eq!(require_titles(&titled), Ok(()));
        for text in ["", "a fragment", "## Part\n# A\n", "# \n## B"] {
            let pages = BTreeMap::from([(PathBuf::from("part.md"), parse(text))]);
            let error = require_titles(&pages).expect_err(text);
            assert!(error.ends_with("a .txt file): part.md"), "{error}");
        }
    }

    #[test]
    fn dead_links_are_named() {
        let pages = BTreeMap::from([
            (PathBuf::from("README.md"), parse("# Top\n")),
            (PathBuf::from("docs/cli.md"), parse("# Command\n")),
        ]);
        let of = |link: &str| problem(Path::new("docs/cli.md"), link, &pages);
        assert_eq!(of("../README.md#top"), None);
        assert_eq!(of("#command"), None);
        assert_eq!(of("../README.md#bottom").as_deref(), Some("README.md has no such heading"));
        assert_eq!(of("missing.md").as_deref(), Some("there is no such file"));
    }
}

//! `cargo xtask site`: all pages of the documentation as one static site, in `target/site`.
//!
//! ```text
//! pages       every Markdown file of the repository becomes HTML at its own path (README.md becomes index.html)
//! files       what pages link to is copied: figures, pictures, sources; a folder becomes a list of its files
//! search      one script with the text of every section, loaded when somebody searches
//! figures     the interactive figures of site/figures.js, over the npm package
//! viewer      the viewer's page, which lessons embed
//! links       every link of every page leads to a file and, if it has one, a heading of the site
//! ```
//!
//! The generator is our own because the parser (pulldown-cmark) is here already, and pages look the same as
//! in the repository: a site of 90 pages is made in a second, without a program that a fresh machine would
//! have to compile first.

mod html;
mod navigation;
mod output;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::dist_js::Build;
use crate::dist_viewer;
use crate::run::{Outcome, output_of, program, root, run, target_folder, to_stderr};
use html::Page;
use output::Output;

/// The files that every page uses.
const STATIC_FILES: [&str; 4] = ["style.css", "search.js", "figures.js", "pairs.js"];

/// Makes the site and prints its folder as the last line.
pub fn make() -> Outcome {
    let folder = target_folder()?.join("site");
    write(&folder)?;
    add_viewer(&folder)?;
    println!("{}", folder.display());
    Ok(())
}

/// `cargo xtask links`: makes the pages alone, and checks their links and titles. Links to other sites are
/// not followed.
pub fn check() -> Outcome {
    write(&target_folder()?.join("site-check"))
}

/// Makes the site and tests it in a browser.
pub fn test() -> Outcome {
    make()?;
    let site = target_folder()?.join("site");
    run(program("node --test site/tests/").env("SITE", site))
}

/// Writes all pages and the files that they use. Errors: a link leads nowhere.
fn write(folder: &Path) -> Outcome {
    let mut output = Output::new(folder)?;
    let pages = read_pages()?;
    require_titles(&pages)?;
    let menu = navigation::Menu::new(&pages);
    for (path, page) in &pages {
        output.write(&html::target(path), menu.document(path, page).as_bytes())?;
    }
    for name in STATIC_FILES {
        output.copy(&root().join("site").join(name), Path::new(name))?;
    }
    output.write(Path::new("search-index.js"), html::search_index(&pages).as_bytes())?;
    let links = pages.values().flat_map(|page| &page.links);
    output.add_linked_files(links.clone())?;
    let dead: Vec<String> = links.filter_map(|link| output.problem(link, &pages)).collect();
    if dead.is_empty() {
        println!(
            "{} pages, {} links",
            pages.len(),
            pages.values().map(|page| page.links.len()).sum::<usize>()
        );
        return Ok(());
    }
    Err(format!("{} links of the site lead nowhere:\n{}", dead.len(), dead.join("\n")))
}

/// All pages by their path in the repository.
fn read_pages() -> Result<BTreeMap<PathBuf, Page>, String> {
    let read = |path: PathBuf| {
        let text = fs::read_to_string(root().join(&path));
        let text = text.map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
        let page = Page::new(&path, &text);
        Ok((path, page))
    };
    page_paths()?.into_iter().map(read).collect()
}

/// The paths of all Markdown files that git knows or would add.
fn page_paths() -> Result<Vec<PathBuf>, String> {
    let listed = output_of(&mut program("git ls-files --cached --others --exclude-standard *.md"))?;
    let listed = String::from_utf8_lossy(&listed);
    Ok(listed.lines().filter(|name| root().join(name).is_file()).map(PathBuf::from).collect())
}

/// Errors: pages that do not begin with a title, which the menu shows.
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

/// Adds the viewer's page, and the entry `darboux` of the npm package, on which the interactive figures
/// compute.
fn add_viewer(folder: &Path) -> Outcome {
    let page = dist_viewer::make_page(Build::Release)?;
    run(to_stderr(program("cp -r").arg(page).arg(folder.join("viewer"))))?;
    let package = dist_viewer::package()?;
    let mut copy = program("cp");
    copy.arg(package.join("darboux.js")).arg(package.join("darboux.scalar.js")).arg(folder);
    run(to_stderr(&mut copy))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pages(files: &[(&str, &str)]) -> BTreeMap<PathBuf, Page> {
        files.iter().map(|(path, text)| (PathBuf::from(path), Page::new(Path::new(path), text))).collect()
    }

    #[test]
    fn pages_without_a_title_are_named() {
        assert_eq!(require_titles(&pages(&[("a.md", "text\n# A\n## B\n")])), Ok(()));
        for text in ["", "a fragment", "## Part\n# A\n", "# \n## B"] {
            let error = require_titles(&pages(&[("part.md", text)])).expect_err(text);
            assert!(error.ends_with("a .txt file): part.md"), "{error}");
        }
    }

    #[test]
    fn dead_links_are_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let output = Output::new(&folder.path().join("site")).expect("a folder");
        let text = "# Command\n[a](../README.md#top) [b](#command) [c](../README.md#bottom) [d](missing.md) \
             ![e](f.png)\n";
        let pages = pages(&[("README.md", "# Top\n"), ("docs/cli.md", text)]);
        for path in pages.keys() {
            output.write(&html::target(path), b"a page").expect("a page");
        }
        let problems: Vec<_> = pages[Path::new("docs/cli.md")]
            .links
            .iter()
            .filter_map(|link| output.problem(link, &pages))
            .collect();
        assert_eq!(
            problems,
            [
                "docs/cli.md: README.md#bottom: there is no such heading",
                "docs/cli.md: docs/missing.md: there is no such file",
                "docs/cli.md: docs/f.png: there is no such file",
            ]
        );
    }
}

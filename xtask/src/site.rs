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
//! The generator is our own because the parser (pulldown-cmark) is here already, and pages look the same as in the repository: a site of 90 pages is
//! made in a second, without a program that a fresh machine would have to compile first.

mod html;
mod navigation;
mod output;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::dist_js::Build;
use crate::dist_viewer;
use crate::links;
use crate::run::{Outcome, program, root, run, target_folder, to_stderr};
use html::Page;
use output::Output;

/// The files that every page uses.
const STATIC_FILES: [&str; 3] = ["style.css", "search.js", "figures.js"];

/// Makes the site and prints its folder as the last line.
pub fn make() -> Outcome {
    let folder = target_folder()?.join("site");
    write(&folder)?;
    add_viewer(&folder)?;
    println!("{}", folder.display());
    Ok(())
}

/// Makes the pages alone, and checks their links.
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
    links::page_paths()?.into_iter().map(read).collect()
}

/// Adds the viewer's page, and the entry `darboux` of the npm package, on which the interactive figures compute.
fn add_viewer(folder: &Path) -> Outcome {
    let page = dist_viewer::make_page(Build::Release)?;
    run(to_stderr(program("cp -r").arg(page).arg(folder.join("viewer"))))?;
    let package = dist_viewer::package()?;
    let mut copy = program("cp");
    copy.arg(package.join("darboux.js")).arg(package.join("darboux.scalar.js")).arg(folder);
    run(to_stderr(&mut copy))
}

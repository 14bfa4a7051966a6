//! `cargo xtask docs [PAGE ...]`: runs every code block of the documentation.
//!
//! Each page gets a folder with sample files. Its blocks run from top to bottom as one shell script, one C,
//! C++, Python or JavaScript program; a TOML block must be a manifest that cargo reads. The page runs twice,
//! because readers repeat commands: a file of the first run must not make the second fail. Rust blocks are
//! doctests, which `cargo test` runs; here only the `include_str!` that makes them doctests is checked.
//!
//! Two comments steer this, each on its own line before a block:
//! `<!-- not run: REASON -->` leaves the next block out. `<!-- hidden LANGUAGE`, code, `-->` is a block that
//! readers do not see. A command that is to fail says so in its comment: `darboux check broken.glb  # exit
//! status 1: there are errors`.

mod blocks;
mod sandbox;

use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use crate::run::{Outcome, files_below, root};
use blocks::Page;
use sandbox::Sandbox;

/// Pages outside `docs`.
const PAGES: &[&str] = &["README.md", "bindings/python/README.md"];

/// Below `docs`: measurements and failed attempts, whose commands belong to the state of the repository at
/// that time.
const NOTES: &str = "docs/notes";

/// Languages whose blocks are text, output or fragments of shaders.
const NOT_RUN: &[&str] = &["glsl", "hlsl", "json", "text", "wgsl", "yaml"];

/// Runs the blocks of the named pages, or of all. Errors: a block fails, a page has a block in a language
/// that nothing runs.
pub fn run(names: &[&str]) -> Outcome {
    let pages =
        if names.is_empty() { all_pages()? } else { names.iter().map(|name| root().join(name)).collect() };
    let sandbox = Sandbox::new()?;
    let mut failed = Vec::new();
    for path in pages {
        let name = path.strip_prefix(root()).unwrap_or(&path).display().to_string();
        let text = fs::read_to_string(&path).map_err(|error| format!("{name} cannot be read: {error}"))?;
        let start = Instant::now();
        let page = blocks::parse(&name, &text)?;
        if let Err(message) = run_page(&page, &sandbox) {
            println!("{message}");
            failed.push(name);
        } else if !page.blocks.is_empty() {
            println!(
                "{name}: {} blocks run twice, {:.1} s",
                page.blocks.len(),
                start.elapsed().as_secs_f32()
            );
        }
    }
    if failed.is_empty() { Ok(()) } else { Err(format!("blocks failed in {}", failed.join(", "))) }
}

/// The text of a page's first block in a language.
pub fn first(page: &str, language: &str) -> Result<String, String> {
    let text =
        fs::read_to_string(root().join(page)).map_err(|error| format!("{page} cannot be read: {error}"))?;
    let blocks = blocks::parse(page, &text)?.blocks;
    let found = blocks.into_iter().find(|block| block.language == language);
    found.map(|block| block.text).ok_or_else(|| format!("{page} has no block in {language}"))
}

fn all_pages() -> Result<Vec<PathBuf>, String> {
    let mut pages: Vec<PathBuf> = PAGES.iter().map(|page| root().join(page)).collect();
    let docs = files_below(&root().join("docs"))?;
    let is_page = |path: &PathBuf| {
        path.extension().is_some_and(|extension| extension == "md") && !path.starts_with(root().join(NOTES))
    };
    pages.extend(docs.into_iter().filter(is_page));
    Ok(pages)
}

fn run_page(page: &Page, sandbox: &Sandbox) -> Outcome {
    for (line, reason) in &page.left_out {
        println!("{}:{line}: not run: {reason}", page.name);
    }
    let of =
        |language: &str| page.blocks.iter().filter(|block| block.language == language).collect::<Vec<_>>();
    for block in &page.blocks {
        let known = ["sh", "c", "cpp", "python", "js", "toml", "rust"].contains(&block.language.as_str());
        if !known && !NOT_RUN.contains(&block.language.as_str()) {
            return Err(format!(
                "{}:{}: nothing runs blocks in \"{}\"; use one of sh, c, cpp, python, js, toml, rust, text",
                page.name, block.line, block.language
            ));
        }
    }
    if !of("rust").is_empty() {
        is_doctest(&page.name)?;
    }
    let folder = sandbox.page_folder(&page.name)?;
    for round in 1..=2 {
        let fail = |message| if round == 1 { message } else { format!("{message} (the second time)") };
        sandbox.shell(page, &of("sh"), &folder).map_err(fail)?;
        sandbox.c_program(page, &of("c"), "c", &folder).map_err(fail)?;
        sandbox.c_program(page, &of("cpp"), "cpp", &folder).map_err(fail)?;
        sandbox.python(page, &of("python"), &folder).map_err(fail)?;
        sandbox.javascript(page, &of("js"), &folder).map_err(fail)?;
        of("toml").iter().try_for_each(|block| sandbox.manifest(page, block, &folder)).map_err(fail)?;
    }
    Ok(())
}

/// Errors: no library includes the page in its documentation, so that `cargo test` does not run the page's
/// Rust blocks.
fn is_doctest(page: &str) -> Outcome {
    let mut folders = vec![root().join("tests/src")];
    let crates = root().join("crates");
    let entries =
        fs::read_dir(&crates).map_err(|error| format!("{} cannot be read: {error}", crates.display()))?;
    folders.extend(entries.filter_map(|entry| Some(entry.ok()?.path().join("src"))));
    let includes = |folder: &PathBuf| {
        let text = fs::read_to_string(folder.join("lib.rs")).unwrap_or_default();
        text.lines().any(|line| line.contains("include_str!") && line.contains(&format!("../{page}\"")))
    };
    if folders.iter().any(includes) {
        Ok(())
    } else {
        Err(format!(
            "{page}: no library includes this page as documentation, so that its Rust blocks are not tested"
        ))
    }
}

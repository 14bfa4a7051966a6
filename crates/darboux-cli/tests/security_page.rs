//! The table of docs/security.md names the test of each promise: each named test exists, in the file that the
//! table names.

use std::fs;
use std::path::{Path, PathBuf};

/// All files of Rust below a folder.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let below = |path: PathBuf| if path.is_dir() { sources(&path) } else { vec![path] };
    entries
        .flat_map(below)
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .collect()
}

/// The words between backticks.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// Whether a word is the name of a test: words joined by underscores.
fn is_test(word: &str) -> bool {
    word.matches('_').count() >= 2
        && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

#[test]
fn the_tests_of_the_security_page_exist() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = fs::read_to_string(root.join("docs/security.md")).expect("the page");
    let table = page.split("## How this is tested").nth(1).expect("the table");
    let files: Vec<(String, String)> = sources(&root.join("crates"))
        .into_iter()
        .map(|path| (path.display().to_string(), fs::read_to_string(&path).expect("a file of Rust")))
        .collect();
    let mut checked = 0;
    for row in table.lines().filter(|line| line.starts_with('|')) {
        let cell = row.rsplit('|').nth(1).expect("a cell");
        let mut tests: Vec<&str> = Vec::new();
        for word in quoted(cell) {
            if is_test(word) {
                tests.push(word);
            } else if word.ends_with(".rs") {
                let named: Vec<_> =
                    files.iter().filter(|(path, _)| path.ends_with(&format!("/{word}"))).collect();
                assert!(!named.is_empty(), "{word} does not exist: {row}");
                for test in tests.drain(..) {
                    let is_here = |(_, text): &&(String, String)| text.contains(&format!("fn {test}("));
                    assert!(
                        named.iter().copied().any(|file| is_here(&file)),
                        "{test} is not in {word}: {row}"
                    );
                    checked += 1;
                }
            }
        }
        assert!(tests.is_empty(), "no file is named after {tests:?}: {row}");
    }
    assert!(checked >= 35, "{checked} tests are named");
}

//! Checks that comments keep the line width of `rustfmt.toml`, which stable rustfmt does not do.
//!
//! `cargo +nightly fmt -- --config wrap_comments=true,comment_width=110` wraps them.

use std::fs;

use crate::run::{Outcome, output_of, program, root};

const WIDTH: usize = 110;

/// Errors: a comment line that is too wide. Blocks of text between ```, addresses and single words may be.
pub fn check() -> Outcome {
    let listed = output_of(&mut program("git ls-files --cached --others --exclude-standard *.rs"))?;
    let mut wide = Vec::new();
    for name in String::from_utf8_lossy(&listed).lines() {
        // A listed file may have been removed.
        let text = fs::read_to_string(root().join(name)).unwrap_or_default();
        wide.extend(wide_lines(&text).map(|line| format!("{name}:{line}")));
    }
    if wide.is_empty() {
        return Ok(());
    }
    Err(format!("comments are wider than {WIDTH} characters; wrap them:\n{}", wide.join("\n")))
}

/// The numbers of comment lines that are too wide.
fn wide_lines(text: &str) -> impl Iterator<Item = usize> {
    let mut is_block = false;
    text.lines().zip(1..).filter_map(move |(line, number)| {
        let comment = line.trim_start().strip_prefix("//");
        let words = comment.map(|comment| comment.trim_start_matches(['/', '!']).trim_start());
        is_block = words.is_some_and(|words| is_block != words.starts_with("```"));
        let may_be_wide = is_block || words.is_none_or(|words| words.contains("://") || !words.contains(' '));
        (!may_be_wide && line.chars().count() > WIDTH).then_some(number)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_comments_are_found_outside_of_blocks() {
        let wide = "word ".repeat(30);
        let text = format!(
            "/// {wide}\nlet x = \"{wide}\";\n//! ```text\n//! {wide}\n//! ```\n    // {wide}\n// \
             https://{wide}"
        );
        assert_eq!(wide_lines(&text).collect::<Vec<_>>(), [1, 6]);
    }
}

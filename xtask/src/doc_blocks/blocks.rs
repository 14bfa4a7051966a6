//! The fenced blocks of a Markdown page.

/// A page and what is to be run of it.
#[derive(Debug, Default, PartialEq)]
pub struct Page {
    /// Its path from the repository's root.
    pub name: String,
    /// Fenced and hidden blocks from top to bottom.
    pub blocks: Vec<Block>,
    /// The lines of blocks that are marked as not run, and the reasons.
    pub left_out: Vec<(usize, String)>,
}

/// The code of one block.
#[derive(Debug, PartialEq)]
pub struct Block {
    /// The first word after the fence, without attributes such as `,no_run`.
    pub language: String,
    /// The line of its first line of code, from 1.
    pub line: usize,
    /// Its lines, each with a line break.
    pub text: String,
}

const NOT_RUN: &str = "<!-- not run:";
const HIDDEN: &str = "<!-- hidden ";

/// Reads a page. Errors: a fence without a language or without an end, a marker without a reason or without a
/// block.
pub fn parse(name: &str, text: &str) -> Result<Page, String> {
    let mut page = Page { name: name.to_owned(), ..Page::default() };
    let mut lines = (1..).zip(text.lines());
    let mut reason: Option<String> = None;
    while let Some((number, line)) = lines.next() {
        let error = |what: &str| format!("{name}:{number}: {what}");
        let mut body = |end: &str| {
            let mut text = String::new();
            for (_, line) in lines.by_ref() {
                if line.trim() == end {
                    return Ok(text);
                }
                text += line;
                text.push('\n');
            }
            Err(error("the block has no end"))
        };
        if let Some(marker) = line.strip_prefix(NOT_RUN) {
            let text = marker.trim().trim_end_matches("-->").trim();
            if text.is_empty() {
                return Err(error("\"not run\" needs a reason"));
            }
            reason = Some(text.to_owned());
        } else if let Some(language) = line.strip_prefix(HIDDEN) {
            let text = body("-->")?;
            page.blocks.push(Block { language: language.trim().to_owned(), line: number + 1, text });
        } else if let Some(info) = line.trim_start().strip_prefix("```") {
            let language = info.split([',', ' ', '{']).next().unwrap_or_default().to_owned();
            let text = body("```")?;
            match reason.take() {
                _ if language.is_empty() => return Err(error("the block names no language")),
                Some(reason) => page.left_out.push((number, reason)),
                None => page.blocks.push(Block { language, line: number + 1, text }),
            }
        } else if reason.is_some() && !line.trim().is_empty() {
            return Err(error("\"not run\" must stand directly before a block"));
        }
    }
    Ok(page)
}

/// The text of blocks in page order, in one program whose line numbers are those of the page.
pub fn at_their_lines(blocks: &[&Block]) -> String {
    let mut text = String::new();
    let mut line = 1;
    for block in blocks {
        while line < block.line {
            text.push('\n');
            line += 1;
        }
        text += &block.text;
        line += block.text.matches('\n').count();
    }
    text
}

/// Shell commands in which a line whose comment names an exit status, as in `darboux check broken.glb  # exit
/// status 1: errors`, must end with it.
pub fn with_exit_statuses(script: &str) -> String {
    let line = |line: &str| match documented_status(line) {
        Some((command, status)) => format!("status=0; {command} || status=$?; test $status = {status}\n"),
        None => format!("{line}\n"),
    };
    script.lines().map(line).collect()
}

/// The command of a line and the exit status in its comment.
fn documented_status(line: &str) -> Option<(&str, u8)> {
    let (command, comment) = line.split_once(" # ")?;
    let (_, words) = comment.split_once("exit status ")?;
    let digits = words.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(words.len());
    Some((command.trim_end(), words[..digits].parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_documented_exit_status_is_asked_for() {
        let script = "darboux check a.glb  # exit status 1: there are errors\necho b # done\n";
        let asked = "status=0; darboux check a.glb || status=$?; test $status = 1\necho b # done\n";
        assert_eq!(with_exit_statuses(script), asked);
    }

    #[test]
    fn blocks_have_languages_and_lines() {
        let text = "# A\n```sh\na\nb\n```\n\n<!-- hidden cpp\nint x;\n-->\n<!-- not run: needs a GPU \
             -->\n```rust,no_run\nc\n```\n";
        let page = parse("a.md", text).expect("a page");
        let block =
            |language: &str, line, text: &str| Block { language: language.into(), line, text: text.into() };
        assert_eq!(page.blocks, [block("sh", 3, "a\nb\n"), block("cpp", 8, "int x;\n")]);
        assert_eq!(page.left_out, [(11, "needs a GPU".to_owned())]);
    }

    #[test]
    fn unclear_pages_are_errors() {
        for (text, message) in [
            ("```\na\n```\n", "a.md:1: the block names no language"),
            ("a\n```sh\nb\n", "a.md:2: the block has no end"),
            ("<!-- not run: -->\n```sh\n```\n", "a.md:1: \"not run\" needs a reason"),
            ("<!-- not run: x -->\ntext\n", "a.md:2: \"not run\" must stand directly before a block"),
        ] {
            assert_eq!(parse("a.md", text), Err(message.to_owned()));
        }
    }
}

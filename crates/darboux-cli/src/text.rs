//! Text for terminals: counts with their nouns, names without control characters, and command lines to copy.

use std::borrow::Cow;
use std::ffi::OsStr;

pub use darboux_io::words::counted;

/// The most characters of a message that are printed.
const MAX_SENTENCE: usize = 1000;

/// Formats ", 3 nouns" for each count that is not zero.
pub fn nonzero_counts<'a>(counts: impl IntoIterator<Item = (usize, &'a str, &'a str)>) -> String {
    let counts = counts.into_iter().filter(|count| count.0 > 0);
    counts.map(|(count, one, many)| format!(", {}", counted(count, one, many))).collect()
}

/// Escapes the characters that a terminal would interpret: control characters, line breaks included, and
/// marks of text direction.
///
/// Names from files must not move the cursor, colour the text or start a line of their own.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(is_unprintable) {
        return Cow::Borrowed(text);
    }
    let escape = |c: char| if is_unprintable(c) { c.escape_debug().to_string() } else { c.to_string() };
    Cow::Owned(text.chars().map(escape).collect())
}

fn is_unprintable(c: char) -> bool {
    c.is_control() || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// A message as a terminal may show it: [`printable`], and cut where a file's content made it too long to
/// read.
pub fn sentence(text: &str) -> Cow<'_, str> {
    let text = printable(text);
    match text.char_indices().nth(MAX_SENTENCE) {
        Some((end, _)) => {
            let rest = text[end..].chars().count();
            Cow::Owned(format!("{} ... ({rest} more characters)", &text[..end]))
        }
        None => text,
    }
}

/// A command line to copy: `darboux` with these arguments and then these file names, quoted for a POSIX
/// shell.
pub fn command_line(arguments: &[&str], files: &[&str]) -> String {
    let separator = files.iter().any(|file| file.starts_with('-')).then_some("--");
    let words = ["darboux"].iter().chain(arguments).copied().chain(separator).chain(files.iter().copied());
    words.map(shell_word).collect::<Vec<_>>().join(" ")
}

/// A word that a POSIX shell takes literally.
pub fn shell_word(word: &str) -> String {
    let is_literal = |c: char| {
        c.is_ascii_alphanumeric() || "-_./,:=@%+".contains(c) || (!c.is_ascii() && !is_unprintable(c))
    };
    if !word.is_empty() && word.chars().all(is_literal) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

/// Replaces each argument that has control characters by its printable form, in a message that quotes
/// arguments.
pub fn with_printable_arguments(message: String, arguments: &[impl AsRef<OsStr>]) -> String {
    arguments.iter().fold(message, |message, argument| {
        let argument = argument.as_ref().to_string_lossy();
        match printable(&argument) {
            Cow::Owned(escaped) => message.replace(&*argument, &escaped),
            Cow::Borrowed(_) => message,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_control_the_terminal() {
        assert_eq!(printable("plain é 網.glb"), "plain é 網.glb");
        assert_eq!(printable("a\x1b[2J\nerror: b\u{202e}"), r"a\u{1b}[2J\nerror: b\u{202e}");
    }

    #[test]
    fn long_sentences_are_cut() {
        assert_eq!(sentence(&"x".repeat(MAX_SENTENCE)).len(), MAX_SENTENCE);
        assert!(sentence(&"\n".repeat(70_000)).len() < 2 * MAX_SENTENCE);
        assert!(sentence(&"é".repeat(70_000)).ends_with("é ... (69000 more characters)"));
    }

    #[test]
    fn suggested_commands_survive_a_shell() {
        assert_eq!(command_line(&["tangents"], &["a.glb"]), "darboux tangents a.glb");
        assert_eq!(
            command_line(&["tangents", "--overwrite"], &["-n.glb"]),
            "darboux tangents --overwrite -- -n.glb"
        );
        assert_eq!(
            command_line(&["tangents"], &["it's a $HOME.glb"]),
            r"darboux tangents 'it'\''s a $HOME.glb'"
        );
        assert_eq!(command_line(&["tangents"], &[""]), "darboux tangents ''");
    }
}

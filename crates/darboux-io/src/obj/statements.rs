//! The statements of an OBJ or MTL.

use memchr::memchr2;

use crate::source::without_byte_order_mark;

/// The statements of a text with the numbers of their lines: the first word, and the rest of the line.
///
/// A byte order mark at the start belongs to no statement. A line that ends with `\` continues on the next
/// one; the rest then contains the line break, which is white space as any other.
pub fn statements(text: &[u8]) -> impl Iterator<Item = (usize, &[u8], &[u8])> {
    let (mut rest, mut number) = (without_byte_order_mark(text), 0);
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let first = number + 1;
        let mut end = 0;
        loop {
            let length = memchr2(b'\n', b'\r', &rest[end..]);
            let line_end = length.map_or(rest.len(), |length| end + length);
            let is_continued = rest[..line_end].ends_with(b"\\");
            let after = line_end + if rest[line_end..].starts_with(b"\r\n") { 2 } else { 1 };
            number += 1;
            if !is_continued || after >= rest.len() {
                let line = rest[..line_end].trim_ascii();
                rest = rest.get(after..).unwrap_or_default();
                let word_end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
                return Some((first, &line[..word_end], line[word_end..].trim_ascii()));
            }
            end = after;
        }
    })
}

/// The words of the rest of a statement, without the marks of continued lines.
#[cfg(feature = "obj")]
pub fn words(rest: &[u8]) -> impl Iterator<Item = &[u8]> {
    rest.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty() && *word != b"\\")
}

/// Whether a statement is a face: `fo` is an older word for it.
pub fn is_face(statement: &[u8]) -> bool {
    matches!(statement, b"f" | b"fo")
}

//! Writes values as text.

use std::borrow::Cow;
use std::fmt;

use super::value::{Number, Value};

/// How a text is laid out: its indentation and line breaks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextLayout {
    /// The white space of one level, in text with line breaks.
    indentation: Option<String>,
    has_carriage_returns: bool,
    ends_with_line_break: bool,
    /// The most bytes of line breaks and indentation.
    most_white_space: usize,
}

/// The longest white space of one level that is kept.
const LONGEST_INDENTATION: usize = 16;

/// The white space of one level in place of a longer one.
const DEFAULT_INDENTATION: &str = "  ";

/// The white space of an output by the size of its input. Text that is nested deeply would need any amount of
/// it. Lines of a few characters on ten levels of two spaces need ten times their own size.
const WHITE_SPACE_PER_BYTE: usize = 16;

/// The white space that the shortest text may get.
const LEAST_WHITE_SPACE: usize = 1 << 20;

/// A member of an object to write: a value, or an array of values.
#[derive(Clone, Copy)]
pub enum Part<'a> {
    Value(&'a Value),
    Elements(&'a [Cow<'a, Value>]),
}

impl TextLayout {
    /// The layout of a JSON text, by the white space before its first key. A longer one than 16 characters
    /// becomes two spaces.
    pub fn of(text: &str) -> Self {
        let first_line = text.trim_start().strip_prefix('{').and_then(|rest| {
            let has_carriage_returns = rest.starts_with("\r\n");
            Some((has_carriage_returns, rest.trim_start_matches('\r').strip_prefix('\n')?))
        });
        let Some((has_carriage_returns, rest)) = first_line else { return Self::default() };
        let indentation = &rest[..rest.len() - rest.trim_start_matches([' ', '\t']).len()];
        let is_kept = indentation.len() <= LONGEST_INDENTATION;
        Self {
            indentation: Some(if is_kept { indentation } else { DEFAULT_INDENTATION }.to_owned()),
            most_white_space: text
                .len()
                .saturating_mul(WHITE_SPACE_PER_BYTE)
                .saturating_add(LEAST_WHITE_SPACE),
            has_carriage_returns,
            ends_with_line_break: text.ends_with('\n'),
        }
    }

    /// The text of a value in this layout.
    pub fn text(&self, value: &Value) -> Vec<u8> {
        let mut writer = Writer::new(self);
        writer.value(value);
        writer.end()
    }

    /// The text of an object in this layout.
    pub fn text_of_object<'a>(&self, members: impl Iterator<Item = (&'a str, Part<'a>)>) -> Vec<u8> {
        let mut writer = Writer::new(self);
        writer.list(b"{}", members, |writer, (key, part)| {
            writer.key(key);
            match part {
                Part::Value(value) => writer.value(value),
                Part::Elements(elements) => {
                    writer.list(b"[]", elements.iter(), |writer, element| writer.value(element));
                }
            }
        });
        writer.end()
    }
}

/// The JSON text without white space.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&String::from_utf8_lossy(&TextLayout::default().text(self)))
    }
}

struct Writer<'a> {
    layout: &'a TextLayout,
    text: Vec<u8>,
    level: usize,
    white_space_left: usize,
}

impl<'a> Writer<'a> {
    fn new(layout: &'a TextLayout) -> Self {
        Self { layout, text: Vec::new(), level: 0, white_space_left: layout.most_white_space }
    }

    fn value(&mut self, value: &Value) {
        match value {
            Value::Null => self.text.extend_from_slice(b"null"),
            Value::Bool(value) => self.text.extend_from_slice(if *value { b"true" } else { b"false" }),
            Value::Number(Number::Whole(number)) => self.whole(*number),
            Value::Number(Number::Spelled(text)) => self.text.extend_from_slice(text.as_bytes()),
            Value::String(text) => self.string(text),
            Value::Array(elements) => {
                self.list(b"[]", elements.iter(), |writer, element| writer.value(element));
            }
            Value::Object(members) => self.list(b"{}", members.iter(), |writer, (key, value)| {
                writer.key(key);
                writer.value(value);
            }),
        }
    }

    /// Writes items between two brackets.
    fn list<I: Iterator>(&mut self, brackets: &[u8; 2], items: I, mut write: impl FnMut(&mut Self, I::Item)) {
        self.text.push(brackets[0]);
        self.level += 1;
        let mut is_empty = true;
        for item in items {
            if !is_empty {
                self.text.push(b',');
            }
            is_empty = false;
            self.line_break();
            write(self, item);
        }
        self.level -= 1;
        if !is_empty {
            self.line_break();
        }
        self.text.push(brackets[1]);
    }

    fn line_break(&mut self) {
        let Some(indentation) = &self.layout.indentation else { return };
        let length = 2 + self.level * indentation.len();
        let Some(left) = self.white_space_left.checked_sub(length) else { return };
        self.white_space_left = left;
        self.text.extend_from_slice(if self.layout.has_carriage_returns { b"\r\n" } else { b"\n" });
        for _ in 0..self.level {
            self.text.extend_from_slice(indentation.as_bytes());
        }
    }

    fn key(&mut self, key: &str) {
        self.string(key);
        self.text.push(b':');
        if self.layout.indentation.is_some() {
            self.text.push(b' ');
        }
    }

    fn whole(&mut self, mut number: u64) {
        let mut digits = [0; 20];
        let mut first = digits.len();
        loop {
            first -= 1;
            digits[first] = b'0' + (number % 10) as u8;
            number /= 10;
            if number == 0 {
                break;
            }
        }
        self.text.extend_from_slice(&digits[first..]);
    }

    fn string(&mut self, text: &str) {
        self.text.push(b'"');
        let bytes = text.as_bytes();
        let mut written = 0;
        for (at, &byte) in bytes.iter().enumerate() {
            if byte >= b' ' && byte != b'"' && byte != b'\\' {
                continue;
            }
            self.text.extend_from_slice(&bytes[written..at]);
            written = at + 1;
            match byte {
                b'"' => self.text.extend_from_slice(b"\\\""),
                b'\\' => self.text.extend_from_slice(b"\\\\"),
                0x08 => self.text.extend_from_slice(b"\\b"),
                0x0C => self.text.extend_from_slice(b"\\f"),
                b'\n' => self.text.extend_from_slice(b"\\n"),
                b'\r' => self.text.extend_from_slice(b"\\r"),
                b'\t' => self.text.extend_from_slice(b"\\t"),
                _ => self.text.extend_from_slice(format!("\\u{byte:04x}").as_bytes()),
            }
        }
        self.text.extend_from_slice(&bytes[written..]);
        self.text.push(b'"');
    }

    fn end(mut self) -> Vec<u8> {
        if self.layout.ends_with_line_break {
            self.text.extend_from_slice(if self.layout.has_carriage_returns { b"\r\n" } else { b"\n" });
        }
        self.text
    }
}

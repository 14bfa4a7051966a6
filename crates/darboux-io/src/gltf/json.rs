//! JSON of documents: text to values and back. Keys keep their order, numbers their digits, and the text its indentation.
//!
//! Exponents are the exception: serde_json writes `1E5` as `1e+5`.

use std::cell::{Cell, RefCell};
use std::fmt;

use serde::de::{DeserializeOwned, DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};
use serde_json::map::Entry;
use serde_json::ser::PrettyFormatter;
use serde_json::{Map, Number, Value};
use serde_path_to_error::Segment;

use crate::error::{ContentError, shortened};
use crate::memory_limit::Budget;

/// The deepest nesting of arrays and objects. Deeper JSON could exhaust the stack of a program that walks it.
const MAX_DEPTH: usize = 100;

/// Parses the JSON of a document.
///
/// Errors: it is not JSON; an object has a key twice, of which readers would see different values; it is nested more than 100 levels deep;
/// a number is beyond the range of 64-bit floats; the value would take more memory than `limit`.
pub fn parse(text: &str, limit: Budget) -> Result<Value, ContentError> {
    let mut parser = serde_json::Deserializer::from_str(text);
    let (bytes_left, failed_at) = (Cell::new(limit.bytes), RefCell::default());
    let root = StrictValue { depth: 0, bytes_left: &bytes_left, failed_at: &failed_at };
    let parsed = root.deserialize(&mut parser).and_then(|value| {
        parser.end()?;
        Ok(value)
    });
    parsed.map_err(|error| {
        if bytes_left.get() == 0 {
            return ContentError::unsupported("", limit.exceeded("has JSON that needs"));
        }
        let at =
            failed_at.borrow().iter().rev().take(LONGEST_PATH).fold(String::new(), |path, step| match step {
                Step::Index(index) => format!("{path}[{index}]"),
                Step::Key(key) if path.is_empty() => key.clone(),
                Step::Key(key) => format!("{path}.{key}"),
            });
        ContentError::invalid(at, format!("{}; export the file again", shortened(&parse_problem(&error))))
    })
}

/// Why a text cannot be parsed, as a clause whose subject is the place.
fn parse_problem(error: &serde_json::Error) -> String {
    let (line, column) = (error.line(), error.column());
    let message = error.to_string();
    let message = message.strip_suffix(&format!(" at line {line} column {column}")).unwrap_or(&message);
    if error.is_data() {
        return message.to_owned();
    }
    let problem = match message {
        _ if error.is_eof() => "the text ends too early",
        "expected `:`" => "a colon is missing",
        "expected `,` or `]`" => "a comma or ] is missing",
        "expected `,` or `}`" => "a comma or } is missing",
        "expected value" => "a value is missing",
        "expected ident" => "the only words outside quotes are true, false and null",
        "key must be a string" => "a key must be a string in quotes",
        "invalid number" => "a number is misspelled",
        "trailing comma" => "a bracket follows a comma",
        "trailing characters" => "more text follows its end",
        "invalid escape" => "a string has a backslash before a character that needs none",
        _ if message.starts_with("control character") => "a string has a control character",
        _ if message.contains("hex escape") || message.contains("code point") => {
            "the digits after \\u in a string are those of no character"
        }
        _ => "its text is wrong",
    };
    format!("is not JSON: {problem} at line {line}, column {column}")
}

/// A part of a document's JSON as another type. `at` is the JSON path of the part. Errors: it is not of that type.
pub fn read<T: DeserializeOwned>(value: &Value, at: &str) -> Result<T, ContentError> {
    // Tracking the path of a failure costs time, so only a value that fails is read again for it.
    T::deserialize(value).or_else(|_| {
        serde_path_to_error::deserialize(value).map_err(|error| {
            let (path, found) = (error.path().to_string(), value_at(value, error.path()));
            let path = if path == "." { "" } else { path.as_str() };
            let separator = if at.is_empty() || path.is_empty() || path.starts_with('[') { "" } else { "." };
            let problem = mismatch(found, &error.inner().to_string());
            ContentError::invalid(
                format!("{at}{separator}{path}"),
                format!("{problem}; export the file again"),
            )
        })
    })
}

/// The value at a path, as far as it exists.
fn value_at<'a>(value: &'a Value, path: &serde_path_to_error::Path) -> &'a Value {
    path.iter().fold(value, |value, segment| match segment {
        Segment::Seq { index } => value.get(index).unwrap_or(value),
        Segment::Map { key } => value.get(key).unwrap_or(value),
        _ => value,
    })
}

/// What is wrong with a value, as a clause whose subject is its place. `message`: that of serde.
fn mismatch(found: &Value, message: &str) -> String {
    if let Some(name) = message.strip_prefix("missing field ") {
        return format!("has no {}", name.trim_matches('`'));
    }
    let expected = match message.rsplit_once(", expected ") {
        Some((_, expected)) => expected_value(expected),
        None if message == "invalid number" => expected_value("usize"),
        None => return shortened(message),
    };
    let found = match found {
        Value::Null => "null".to_owned(),
        Value::Array(_) => "an array".to_owned(),
        Value::Object(_) => "an object".to_owned(),
        other => shortened(&other.to_string()),
    };
    format!("is {found}; it must be {expected}")
}

/// A type in the words of JSON. `name`: as serde calls it.
fn expected_value(name: &str) -> String {
    match name {
        "usize" | "u64" | "u32" => "a whole number of 0 or more".to_owned(),
        "f32" | "f64" => "a number".to_owned(),
        "a map" => "an object".to_owned(),
        "a sequence" => "an array".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "string or map" | "map with a single key" => "a string".to_owned(),
        name if name.starts_with("struct ") => "an object".to_owned(),
        name => match name.strip_prefix("an array of length ") {
            Some(length) => format!("an array of {length} numbers"),
            None => name.replace('`', ""),
        },
    }
}

/// The key by which serde_json passes numbers with their spelling, apart from integers of 64 bits.
const NUMBER_KEY: &str = "$serde_json::private::Number";

/// The memory of a value, its text included; of a member, its key included; and of the table of an object.
const BYTES_PER_VALUE: usize = 112;
const BYTES_PER_MEMBER: usize = 48;
const BYTES_PER_TABLE: usize = 400;

/// The most steps of a path in a message; those of glTF have fewer.
const LONGEST_PATH: usize = 12;

/// A step of the path to the value that cannot be read.
enum Step {
    Index(usize),
    Key(String),
}

/// Reads a value strictly.
#[derive(Clone, Copy)]
struct StrictValue<'a> {
    depth: usize,
    /// The memory that values may still take; 0 once it is spent.
    bytes_left: &'a Cell<usize>,
    /// The path to the value that cannot be read, its last step first.
    failed_at: &'a RefCell<Vec<Step>>,
}

impl StrictValue<'_> {
    fn inner<E: serde::de::Error>(self) -> Result<Self, E> {
        if self.depth == MAX_DEPTH {
            return Err(E::custom(format_args!("the JSON is nested more than {MAX_DEPTH} levels deep")));
        }
        Ok(Self { depth: self.depth + 1, ..self })
    }

    /// Adds a step to the path of a value that cannot be read.
    fn fail<E>(self, error: E, step: Step) -> E {
        self.failed_at.borrow_mut().push(step);
        error
    }

    fn spend<E: serde::de::Error>(self, bytes: usize) -> Result<(), E> {
        self.bytes_left.set(self.bytes_left.get().saturating_sub(bytes));
        if self.bytes_left.get() == 0 { Err(E::custom("more than the memory limit")) } else { Ok(()) }
    }
}

impl<'de> DeserializeSeed<'de> for StrictValue<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for StrictValue<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_string<E>(self, value: String) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Value, A::Error> {
        let inner = self.inner()?;
        let mut array = Vec::new();
        let next = |elements: &mut A, index| {
            elements.next_element_seed(inner).map_err(|error| self.fail(error, Step::Index(index)))
        };
        while let Some(element) = next(&mut elements, array.len())? {
            self.spend(BYTES_PER_VALUE)?;
            array.push(element);
        }
        Ok(Value::Array(array))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<Value, A::Error> {
        let inner = self.inner()?;
        let mut object = Map::new();
        while let Some(key) = members.next_key::<Key>()? {
            let Key::Member(key) = key else { return number(&members.next_value::<String>()?) };
            if object.is_empty() {
                self.spend(BYTES_PER_TABLE)?;
            }
            match object.entry(key) {
                Entry::Vacant(entry) => {
                    self.spend(BYTES_PER_VALUE + BYTES_PER_MEMBER + entry.key().len())?;
                    let value = members.next_value_seed(inner);
                    let value = value.map_err(|error| self.fail(error, Step::Key(entry.key().clone())))?;
                    entry.insert(value);
                }
                Entry::Occupied(entry) => {
                    return Err(A::Error::custom(format_args!(
                        "an object has the key {:?} twice",
                        entry.key()
                    )));
                }
            }
        }
        Ok(Value::Object(object))
    }
}

fn number<E: serde::de::Error>(spelling: &str) -> Result<Value, E> {
    // Only an exponent or hundreds of digits can leave the range.
    let may_be_infinite = spelling.len() > 300 || spelling.contains(['e', 'E']);
    let is_infinite = may_be_infinite && !spelling.parse().is_ok_and(f64::is_finite);
    match spelling.parse::<Number>() {
        Ok(number) if !is_infinite => Ok(Value::Number(number)),
        _ => Err(E::custom(format_args!("the number {} is out of range", shortened(spelling)))),
    }
}

/// A key of an object, or the mark of a number.
enum Key {
    Member(String),
    Number,
}

impl<'de> Deserialize<'de> for Key {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct KeyVisitor;

        impl Visitor<'_> for KeyVisitor {
            type Value = Key;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a key")
            }

            fn visit_str<E>(self, key: &str) -> Result<Key, E> {
                Ok(if key == NUMBER_KEY { Key::Number } else { Key::Member(key.to_owned()) })
            }

            fn visit_string<E>(self, key: String) -> Result<Key, E> {
                Ok(if key == NUMBER_KEY { Key::Number } else { Key::Member(key) })
            }
        }

        deserializer.deserialize_str(KeyVisitor)
    }
}

/// How a text is laid out: its indentation and line breaks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextLayout {
    /// The white space of one level, in text with line breaks.
    indentation: Option<String>,
    has_carriage_returns: bool,
    ends_with_line_break: bool,
}

impl TextLayout {
    /// The layout of a JSON text, by the white space before its first key.
    pub fn of(text: &str) -> Self {
        let first_line = text.trim_start().strip_prefix('{').and_then(|rest| {
            let has_carriage_returns = rest.starts_with("\r\n");
            Some((has_carriage_returns, rest.trim_start_matches('\r').strip_prefix('\n')?))
        });
        let Some((has_carriage_returns, rest)) = first_line else { return Self::default() };
        Self {
            indentation: Some(rest.chars().take_while(|c| matches!(c, ' ' | '\t')).collect()),
            has_carriage_returns,
            ends_with_line_break: text.ends_with('\n'),
        }
    }

    /// The text of a value in this layout.
    pub fn text(&self, value: &impl Serialize) -> serde_json::Result<Vec<u8>> {
        let Some(indentation) = &self.indentation else { return serde_json::to_vec(value) };
        let mut text = Vec::new();
        let formatter = PrettyFormatter::with_indent(indentation.as_bytes());
        value.serialize(&mut serde_json::Serializer::with_formatter(&mut text, formatter))?;
        if self.ends_with_line_break {
            text.push(b'\n');
        }
        // Strings have no line breaks of their own: JSON escapes them.
        let pieces = self.has_carriage_returns.then(|| text.split(|&byte| byte == b'\n'));
        Ok(pieces.map_or_else(|| text.clone(), |pieces| pieces.collect::<Vec<_>>().join(&b"\r\n"[..])))
    }
}

/// Removes an extension from an object, and an `extensions` that is empty then. Returns whether the object had it.
pub fn remove_extension(object: &mut Value, name: &str) -> bool {
    let Some(object) = object.as_object_mut() else { return false };
    let Some(Value::Object(extensions)) = object.get_mut("extensions") else { return false };
    let is_removed = extensions.shift_remove(name).is_some();
    if is_removed && extensions.is_empty() {
        object.shift_remove("extensions");
    }
    is_removed
}

/// Parses JSON without a limit of memory.
#[cfg(test)]
pub fn parse_test(text: &str) -> Result<Value, ContentError> {
    parse(text, Budget { bytes: usize::MAX, is_of_process: false, option: "" })
}

#[cfg(test)]
mod tests {
    use super::parse_test as parse;
    use super::*;

    fn problem(text: &str) -> String {
        parse(text).expect_err("invalid JSON").into_clause()
    }

    #[test]
    fn order_and_spelling_are_kept() {
        let text = r#"{"b":1e+5,"a":[0.10,-0,1.0e-7,18446744073709551616],"c":{"é":null,"$x":true}}"#;
        let parsed = parse(text).unwrap();
        assert_eq!(TextLayout::default().text(&parsed).unwrap(), text.as_bytes());
    }

    #[test]
    fn text_keeps_its_indentation() {
        for text in ["{\n\t\"a\": [\n\t\t1,\n\t\t{}\n\t]\n}\n", "{\r\n  \"a\": 1\r\n}", "{\n    \"a\": []\n}"]
        {
            let written = TextLayout::of(text).text(&parse(text).unwrap()).unwrap();
            assert_eq!(String::from_utf8(written).unwrap(), text);
        }
    }

    #[test]
    fn hostile_json_is_refused_in_a_sentence() {
        let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
        assert!(problem(&deep).contains("nested more than 100 levels deep"), "{}", problem(&deep));
        let allowed = format!("{}{}", "[".repeat(100), "]".repeat(100));
        assert!(parse(&allowed).is_ok());
        assert!(problem(r#"{"a":1,"b":{"a":1,"\u0061":2}}"#).contains("an object has the key \"a\" twice"));
        assert!(problem("[1e400]").contains("the number 1e+400 is out of range"));
        let sentence = |text: &str| parse(text).expect_err("invalid JSON").in_file("f").to_string();
        assert!(
            sentence("{\"a\":[0,{\"b\":1e400}]}")
                .starts_with("f: a[1].b: the number 1e+400 is out of range; ")
        );
        for (text, expected) in [
            ("[1,]", "a bracket follows a comma"),
            ("{} {}", "more text follows its end"),
            ("[1 2]", "a comma or ] is missing"),
            ("[1 ", "the text ends too early"),
            ("[nul]", "the only words outside quotes are true, false and null"),
            ("[\"\\ud800\"]", "the digits after \\u in a string are those of no character"),
            ("[\"\u{1}\"]", "a string has a control character"),
            ("[-]", "a number is misspelled"),
        ] {
            assert!(
                problem(text).starts_with(&format!("is not JSON: {expected} at line 1, column ")),
                "{}",
                problem(text)
            );
        }
        let limit = Budget { bytes: 1 << 20, is_of_process: false, option: "--memory-limit" };
        let many = format!("[{}0]", "{\"\":0},".repeat(10_000));
        let refused = super::parse(&many, limit).expect_err("6 MB").into_clause();
        assert!(refused.contains("has JSON that needs more than the memory limit of 1 MiB"), "{refused}");
    }

    #[test]
    fn the_path_of_a_wrong_type_is_named() {
        #[derive(Debug, Deserialize)]
        struct Inner {
            #[expect(dead_code, reason = "only read")]
            count: usize,
        }
        let value = parse(r#"{"list":[{"count":1},{"count":"x"}]}"#).unwrap();
        let error = read::<Vec<Inner>>(&value["list"], "list").expect_err("a string").in_file("f");
        let expected =
            "f: list[1].count: is \"x\"; it must be a whole number of 0 or more; export the file again";
        assert_eq!(error.to_string(), expected);
    }
}

//! Parses text strictly as JSON (RFC 8259).

use super::value::{Key, Map, Number, Value};
use crate::error::{ContentError, shortened};
use crate::memory_limit::Budget;

/// The deepest nesting of arrays and objects. Deeper JSON could exhaust the stack of a program that walks it.
const MAX_DEPTH: usize = 100;

/// The memory of a value without its text, and of a member of an object with its value: in the finished list,
/// in the list that grew, and for a member in the index of its key.
const BYTES_PER_VALUE: usize = 96;
const BYTES_PER_MEMBER: usize = 224;

/// The most steps of a path in a message; paths of glTF have fewer.
const LONGEST_PATH: usize = 12;

/// Parses the JSON of a document.
///
/// Errors: it is not JSON; an object has a key twice, of which readers would see different values; it is
/// nested more than 100 levels deep; a number is beyond the range of 64-bit floats; the value would take more
/// memory than `limit`.
pub fn parse(text: &str, limit: Budget) -> Result<Value, ContentError> {
    let mut parser = Parser {
        text,
        at: 0,
        depth: 0,
        bytes_left: limit.bytes,
        values: Vec::new(),
        members: Vec::new(),
        failed_at: Vec::new(),
    };
    parser.document().map_err(|problem| {
        let (place, problem) = match problem {
            Problem::Memory => return ContentError::unsupported("", limit.exceeded("has JSON that needs")),
            Problem::Syntax(problem) => {
                let (line, column) = parser.line_and_column();
                let problem = format!("is not JSON: {problem} at line {line}, column {column}");
                (parser.place(), problem)
            }
            Problem::Content(problem) => (parser.place(), shortened(&problem)),
        };
        ContentError::invalid(place, format!("{problem}; export the file again"))
    })
}

/// Why a text cannot be parsed.
enum Problem {
    /// A clause about the text where the parser is.
    Syntax(&'static str),
    /// A clause whose subject is the value.
    Content(String),
    /// The values need more memory than they may take.
    Memory,
}

/// A step of the path to the value that cannot be read.
enum Step {
    Index(usize),
    Key(Key),
}

struct Parser<'a> {
    text: &'a str,
    /// The place of the next byte.
    at: usize,
    depth: usize,
    bytes_left: usize,
    /// The elements and members of all arrays and objects that are not complete.
    values: Vec<Value>,
    members: Vec<(Key, Value)>,
    /// The path to the value that cannot be read, its last step first.
    failed_at: Vec<Step>,
}

const ENDS_EARLY: Problem = Problem::Syntax("the text ends too early");

impl<'a> Parser<'a> {
    fn document(&mut self) -> Result<Value, Problem> {
        let value = self.value()?;
        match self.next_token() {
            None => Ok(value),
            Some(_) => Err(Problem::Syntax("more text follows its end")),
        }
    }

    fn line_and_column(&self) -> (usize, usize) {
        let before = &self.text.as_bytes()[..self.at.min(self.text.len())];
        let line = before.iter().filter(|&&byte| byte == b'\n').count();
        let start = before.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
        (line + 1, before.len() - start + 1)
    }

    /// The JSON path of the value that cannot be read.
    fn place(&self) -> String {
        let steps = self.failed_at.iter().rev().take(LONGEST_PATH);
        steps.fold(String::new(), |path, step| match step {
            Step::Index(index) => format!("{path}[{index}]"),
            Step::Key(key) if path.is_empty() => key.to_string(),
            Step::Key(key) => format!("{path}.{key}"),
        })
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    /// The first byte after white space, which stays the next one.
    fn next_token(&mut self) -> Option<u8> {
        while let Some(b' ' | b'\t' | b'\n' | b'\r') = self.peek() {
            self.at += 1;
        }
        self.peek()
    }

    fn spend(&mut self, bytes: usize) -> Result<(), Problem> {
        self.bytes_left = self.bytes_left.checked_sub(bytes).ok_or(Problem::Memory)?;
        Ok(())
    }

    fn value(&mut self) -> Result<Value, Problem> {
        match self.next_token().ok_or(ENDS_EARLY)? {
            b'{' => self.nested(Self::object),
            b'[' => self.nested(Self::array),
            b'"' => {
                let text = self.string()?;
                self.spend(text.len())?;
                Ok(Value::String(text.into()))
            }
            b'-' | b'0'..=b'9' => self.number().map(Value::Number),
            b't' => self.word("true", Value::Bool(true)),
            b'f' => self.word("false", Value::Bool(false)),
            b'n' => self.word("null", Value::Null),
            _ => Err(Problem::Syntax("a value is missing")),
        }
    }

    fn word(&mut self, word: &str, value: Value) -> Result<Value, Problem> {
        let rest = &self.text[self.at..];
        if !rest.starts_with(word) {
            let is_cut_off = word.starts_with(rest);
            let problem = Problem::Syntax("the only words outside quotes are true, false and null");
            return Err(if is_cut_off { ENDS_EARLY } else { problem });
        }
        self.at += word.len();
        Ok(value)
    }

    /// Reads an array or object after its first bracket.
    fn nested(&mut self, read: fn(&mut Self) -> Result<Value, Problem>) -> Result<Value, Problem> {
        if self.depth == MAX_DEPTH {
            let problem = format!("the JSON is nested more than {MAX_DEPTH} levels deep");
            return Err(Problem::Content(problem));
        }
        self.at += 1;
        self.depth += 1;
        let value = read(self)?;
        self.depth -= 1;
        Ok(value)
    }

    fn array(&mut self) -> Result<Value, Problem> {
        let first = self.values.len();
        let mut is_last = self.next_token() == Some(b']');
        self.at += usize::from(is_last);
        while !is_last {
            let index = self.values.len() - first;
            let element = self.value().inspect_err(|_| self.failed_at.push(Step::Index(index)))?;
            self.spend(BYTES_PER_VALUE)?;
            self.values.push(element);
            is_last = self.separator(b']', "a comma or ] is missing")?;
        }
        Ok(Value::Array(self.values.drain(first..).collect()))
    }

    fn object(&mut self) -> Result<Value, Problem> {
        let first = self.members.len();
        let mut is_last = self.next_token() == Some(b'}');
        self.at += usize::from(is_last);
        while !is_last {
            let key = self.key()?;
            self.spend(BYTES_PER_MEMBER + key.len())?;
            match self.value() {
                Ok(value) => self.members.push((key, value)),
                Err(problem) => {
                    self.failed_at.push(Step::Key(key));
                    return Err(problem);
                }
            }
            is_last = self.separator(b'}', "a comma or } is missing")?;
        }
        let members: Vec<_> = self.members.drain(first..).collect();
        Map::from_members(members)
            .map(Value::Object)
            .map_err(|key| Problem::Content(format!("an object has the key {key:?} twice")))
    }

    fn key(&mut self) -> Result<Key, Problem> {
        match self.next_token().ok_or(ENDS_EARLY)? {
            b'"' => {}
            _ => return Err(Problem::Syntax("a key must be a string in quotes")),
        }
        let key = self.string()?.as_ref().into();
        match self.next_token().ok_or(ENDS_EARLY)? {
            b':' => self.at += 1,
            _ => return Err(Problem::Syntax("a colon is missing")),
        }
        Ok(key)
    }

    /// Reads a comma, or the bracket at the end of a list, after which it returns true.
    fn separator(&mut self, end: u8, missing: &'static str) -> Result<bool, Problem> {
        match self.next_token().ok_or(ENDS_EARLY)? {
            b',' => {
                self.at += 1;
                if self.next_token() == Some(end) {
                    return Err(Problem::Syntax("a bracket follows a comma"));
                }
                Ok(false)
            }
            byte if byte == end => {
                self.at += 1;
                Ok(true)
            }
            _ => Err(Problem::Syntax(missing)),
        }
    }

    fn number(&mut self) -> Result<Number, Problem> {
        const MISSPELLED: Problem = Problem::Syntax("a number is misspelled");
        let start = self.at;
        self.at += usize::from(self.peek() == Some(b'-'));
        let first_digit = self.at;
        let digits = self.digits();
        if digits == 0 || (digits > 1 && self.text.as_bytes()[first_digit] == b'0') {
            return Err(MISSPELLED);
        }
        let end_of_digits = self.at;
        if self.peek() == Some(b'.') {
            self.at += 1;
            if self.digits() == 0 {
                return Err(MISSPELLED);
            }
        }
        let mut has_exponent = false;
        if let Some(b'e' | b'E') = self.peek() {
            has_exponent = true;
            self.at += 1;
            self.at += usize::from(matches!(self.peek(), Some(b'+' | b'-')));
            if self.digits() == 0 {
                return Err(MISSPELLED);
            }
        }
        let spelling = &self.text[start..self.at];
        // Without a sign and a fraction, the text of the number is the same after it was read.
        if (start, end_of_digits) == (first_digit, self.at)
            && let Ok(number) = spelling.parse()
        {
            return Ok(Number::Whole(number));
        }
        // Only an exponent or hundreds of digits can leave the range.
        let may_be_infinite = has_exponent || spelling.len() > 300;
        if may_be_infinite && !spelling.parse().is_ok_and(f64::is_finite) {
            return Err(Problem::Content(format!("the number {} is out of range", shortened(spelling))));
        }
        self.spend(spelling.len())?;
        Ok(Number::Spelled(spelling.into()))
    }

    /// Skips digits. Returns how many there are.
    fn digits(&mut self) -> usize {
        let start = self.at;
        while let Some(b'0'..=b'9') = self.peek() {
            self.at += 1;
        }
        self.at - start
    }

    /// Reads a string after white space.
    fn string(&mut self) -> Result<std::borrow::Cow<'a, str>, Problem> {
        self.at += 1;
        let (mut start, mut text) = (self.at, String::new());
        loop {
            match self.peek().ok_or(ENDS_EARLY)? {
                b'"' => {
                    let rest = &self.text[start..self.at];
                    self.at += 1;
                    return Ok(if text.is_empty() { rest.into() } else { (text + rest).into() });
                }
                b'\\' => {
                    text += &self.text[start..self.at];
                    self.at += 1;
                    text.push(self.escape()?);
                    start = self.at;
                }
                0..b' ' => return Err(Problem::Syntax("a string has a control character")),
                _ => self.at += 1,
            }
        }
    }

    /// Reads an escape after its backslash.
    fn escape(&mut self) -> Result<char, Problem> {
        const NO_ESCAPE: Problem =
            Problem::Syntax("a string has a backslash before a character that needs none");
        const NO_CHARACTER: Problem =
            Problem::Syntax("the digits after \\u in a string are those of no character");
        let escape = self.peek().ok_or(ENDS_EARLY)?;
        self.at += 1;
        Ok(match escape {
            b'"' | b'\\' | b'/' => escape as char,
            b'b' => '\u{8}',
            b'f' => '\u{C}',
            b'n' => '\n',
            b'r' => '\r',
            b't' => '\t',
            b'u' => {
                let mut code = self.hex_digits().ok_or(NO_CHARACTER)?;
                if let 0xD800..0xDC00 = code {
                    let low = self.text[self.at..].starts_with("\\u").then(|| {
                        self.at += 2;
                        self.hex_digits().filter(|low| (0xDC00..0xE000).contains(low))
                    });
                    code = 0x1_0000 + ((code - 0xD800) << 10 | (low.flatten().ok_or(NO_CHARACTER)? - 0xDC00));
                }
                char::from_u32(code).ok_or(NO_CHARACTER)?
            }
            _ => return Err(NO_ESCAPE),
        })
    }

    /// Reads four hexadecimal digits.
    fn hex_digits(&mut self) -> Option<u32> {
        let digits = self.text.as_bytes().get(self.at..self.at + 4)?;
        let code =
            digits.iter().try_fold(0, |code, &digit| Some(code << 4 | char::from(digit).to_digit(16)?));
        self.at += 4;
        code
    }
}

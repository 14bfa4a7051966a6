//! The numbers after a header, one after the other; in ASCII, the numbers of a record are on one line.

use memchr::memchr2;

use super::header::{Encoding, Header, NumberType};

/// Reads numbers.
#[derive(Clone, Debug)]
pub struct Values<'a> {
    encoding: Encoding,
    /// The whole file.
    file: &'a [u8],
    rest: &'a [u8],
    /// Whether each record is a line.
    by_lines: bool,
    /// The number of bytes from the start of the record's line to the end of the file.
    line_to_end: usize,
    pub surplus: Surplus,
}

/// Surplus values on the line of a record.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surplus {
    pub values: usize,
    pub lines: usize,
    /// The number of bytes from the start of the first such line to the end of the file.
    line_to_end: usize,
}

impl<'a> Values<'a> {
    /// The values after the header of a file. `by_lines`: whether each record of an ASCII file is a line.
    pub fn new(file: &'a [u8], header: &Header, by_lines: bool) -> Self {
        let rest = &file[header.end..];
        Self {
            encoding: header.encoding,
            file,
            rest,
            by_lines: by_lines && header.encoding == Encoding::Ascii,
            line_to_end: rest.len(),
            surplus: Surplus::default(),
        }
    }

    /// Begins a record: goes to the next line with values, where records are lines.
    #[inline]
    pub fn begin_record(&mut self) {
        if self.by_lines {
            let start = self.rest.iter().position(|byte| !byte.is_ascii_whitespace());
            self.rest = &self.rest[start.unwrap_or(self.rest.len())..];
            self.line_to_end = self.rest.len();
        }
    }

    /// Ends a record: counts what its line has after the record's values.
    #[inline]
    pub fn end_record(&mut self) {
        if !self.by_lines {
            return;
        }
        let next = self.rest.iter().find(|byte| !matches!(byte, b' ' | b'\t'));
        if next.is_some_and(|byte| !is_line_end(byte)) {
            let end = memchr2(b'\n', b'\r', self.rest).unwrap_or(self.rest.len());
            let (line, rest) = self.rest.split_at(end);
            self.rest = rest;
            let words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            self.surplus.values += words.count();
            self.surplus.lines += 1;
            if self.surplus.lines == 1 {
                self.surplus.line_to_end = self.line_to_end;
            }
        }
    }

    /// The number of the record's line, and the last text that was read if it is no number. None: records are
    /// not lines, or no line is left.
    pub fn wrong_line(&self) -> Option<(usize, Option<&'a [u8]>)> {
        if !self.by_lines || self.line_to_end == 0 {
            return None;
        }
        let read = &self.file[self.file.len() - self.line_to_end..self.file.len() - self.rest.len()];
        let last = read.split(u8::is_ascii_whitespace).rfind(|word| !word.is_empty());
        let is_number = |word: &[u8]| str::from_utf8(word).is_ok_and(|text| text.parse::<f64>().is_ok());
        Some((self.line_number(self.line_to_end), last.filter(|word| !is_number(word))))
    }

    /// Whether records that could not be read line by line may wrap or share lines: the last text that was
    /// read is a number, and values are left, after it or on lines before.
    pub fn may_wrap(&self) -> bool {
        let share_lines = self.surplus.lines > 0;
        self.wrong_line().map_or(share_lines, |(_, wrong)| {
            wrong.is_none() && (share_lines || !self.rest.trim_ascii().is_empty())
        })
    }

    /// The number of the first line with surplus values.
    pub fn first_surplus_line(&self) -> usize {
        self.line_number(self.surplus.line_to_end)
    }

    /// The number of the line that begins so many bytes before the end of the file.
    fn line_number(&self, to_end: usize) -> usize {
        let before = &self.file[..self.file.len() - to_end];
        let is_break = |&at: &usize| before[at] == b'\n' || !before[at + 1..].starts_with(b"\n");
        1 + memchr::memchr2_iter(b'\n', b'\r', before).filter(is_break).count()
    }

    pub fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// What follows.
    pub fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// How many bytes are left.
    pub fn left(&self) -> usize {
        self.rest.len()
    }

    /// So many bytes of a binary file; none if fewer are left.
    pub fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (bytes, rest) = self.rest.split_at_checked(count)?;
        self.rest = rest;
        Some(bytes)
    }

    /// The next number; none at the end, or where the text is no number.
    #[inline]
    pub fn next(&mut self, number: NumberType) -> Option<f64> {
        match self.encoding {
            Encoding::Ascii => {
                let word = self.word()?;
                match number {
                    NumberType::F32 => word.parse::<f32>().ok().map(f64::from),
                    _ => word.parse().ok(),
                }
            }
            encoding => Some(decode(number, encoding, self.bytes(number.size())?)),
        }
    }

    fn word(&mut self) -> Option<&'a str> {
        let start = self.rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        if self.by_lines && self.rest[..start].iter().any(is_line_end) {
            return None;
        }
        let rest = &self.rest[start..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.rest = &rest[end..];
        str::from_utf8(&rest[..end]).ok()
    }
}

fn is_line_end(byte: &u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

/// A number of its type's size. The caller gives as many bytes.
#[inline]
pub fn decode(number: NumberType, encoding: Encoding, bytes: &[u8]) -> f64 {
    let is_little = encoding == Encoding::LittleEndian;
    macro_rules! number {
        ($type:ty) => {{
            let bytes = bytes.first_chunk().copied().unwrap_or_default();
            f64::from(if is_little { <$type>::from_le_bytes(bytes) } else { <$type>::from_be_bytes(bytes) })
        }};
    }
    match number {
        NumberType::I8 => number!(i8),
        NumberType::U8 => number!(u8),
        NumberType::I16 => number!(i16),
        NumberType::U16 => number!(u16),
        NumberType::I32 => number!(i32),
        NumberType::U32 => number!(u32),
        NumberType::F32 => number!(f32),
        NumberType::F64 => number!(f64),
    }
}

//! The numbers after a header, one after the other.

use super::header::{Encoding, NumberType};

/// Reads numbers.
#[derive(Clone, Debug)]
pub struct Values<'a> {
    encoding: Encoding,
    rest: &'a [u8],
}

impl<'a> Values<'a> {
    pub fn new(encoding: Encoding, bytes: &'a [u8]) -> Self {
        Self { encoding, rest: bytes }
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
        let rest = &self.rest[start..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.rest = &rest[end..];
        str::from_utf8(&rest[..end]).ok()
    }
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

//! The header of a PLY: its encoding, its elements and their properties.

use crate::code_page::decoded;
use crate::error::ContentError;

/// How the numbers after the header are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl NumberType {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// The number of bytes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The value that colours of this type have at full intensity.
    pub fn full_intensity(self) -> f64 {
        match self {
            Self::I8 | Self::U8 => 255.0,
            Self::I16 | Self::U16 => 65535.0,
            Self::I32 | Self::U32 => f64::from(u32::MAX),
            Self::F32 | Self::F64 => 1.0,
        }
    }
}

/// A property of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Property {
    pub name: String,
    /// The type of a list's length; none for a single number.
    pub length: Option<NumberType>,
    pub number: NumberType,
}

/// An element: a name, how often it occurs, and what each occurrence holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
}

impl Element {
    /// The least number of bytes of an occurrence.
    pub fn least_bytes(&self, encoding: Encoding) -> usize {
        match encoding {
            // A digit and a space each.
            Encoding::Ascii => 2 * self.properties.len(),
            _ => {
                self.properties.iter().map(|property| property.length.unwrap_or(property.number).size()).sum()
            }
        }
    }
}

/// A header.
#[derive(Clone, Debug)]
pub struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    pub comments: Vec<String>,
    /// Where the numbers begin.
    pub end: usize,
}

/// The most bytes of a header.
const LONGEST_HEADER: usize = 1 << 20;

/// Parses a header. Errors: it does not end; a line is not as PLY has it.
pub fn parse(bytes: &[u8]) -> Result<Header, ContentError> {
    let mut header = Header { encoding: Encoding::Ascii, elements: Vec::new(), comments: Vec::new(), end: 0 };
    let mut has_format = false;
    let mut number = 0;
    while header.end < LONGEST_HEADER {
        let rest = &bytes[header.end..];
        let Some(length) = rest.iter().position(|&byte| byte == b'\n' || byte == b'\r') else { break };
        let line = decoded(&rest[..length]);
        // A line ends with \n, \r\n or, in old files, \r.
        header.end += length + if rest[length..].starts_with(b"\r\n") { 2 } else { 1 };
        number += 1;
        let words: Vec<&str> = line.split_whitespace().collect();
        let understood = match words[..] {
            ["end_header"] if has_format => return Ok(header),
            ["ply"] | [] => true,
            ["format", encoding, _] => {
                has_format = true;
                header.set_encoding(encoding)
            }
            ["comment" | "obj_info", ..] => {
                header.comments.push(line.trim().to_owned());
                true
            }
            ["element", name, count] => header.add_element(name, count),
            ["property", ref property @ ..] => header.add_property(property),
            _ => false,
        };
        if !understood {
            let problem = "is no line of a PLY header; export the file again";
            return Err(ContentError::invalid(format!("line {number}"), problem));
        }
    }
    Err(ContentError::invalid("", "has a PLY header without an end; export or download it again"))
}

impl Header {
    fn set_encoding(&mut self, name: &str) -> bool {
        self.encoding = match name {
            "ascii" => Encoding::Ascii,
            "binary_little_endian" => Encoding::LittleEndian,
            "binary_big_endian" => Encoding::BigEndian,
            _ => return false,
        };
        true
    }

    fn add_element(&mut self, name: &str, count: &str) -> bool {
        let Ok(count) = count.parse() else { return false };
        self.elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
        true
    }

    fn add_property(&mut self, words: &[&str]) -> bool {
        let (length, number, name) = match *words {
            ["list", length, number, name] => {
                let Some(length) = NumberType::of(length) else { return false };
                (Some(length), number, name)
            }
            [number, name] => (None, number, name),
            _ => return false,
        };
        let (Some(number), Some(element)) = (NumberType::of(number), self.elements.last_mut()) else {
            return false;
        };
        element.properties.push(Property { name: name.to_owned(), length, number });
        true
    }
}

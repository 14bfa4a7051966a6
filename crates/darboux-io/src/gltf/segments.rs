//! An output as a list of byte segments, so that no file is assembled in memory.

use std::io::{self, Write};
use std::ops::Deref;

use super::file_bytes::FileBytes;

/// A run of bytes of an output.
#[derive(Debug)]
pub enum Segment<'a> {
    /// Bytes of the document.
    Borrowed(&'a [u8]),
    /// Bytes made for the output.
    Owned(Vec<u8>),
    /// The content of a file.
    File(FileBytes),
}

impl Deref for Segment<'_> {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            Self::Borrowed(bytes) => bytes,
            Self::Owned(bytes) => bytes,
            Self::File(bytes) => bytes,
        }
    }
}

/// The number of bytes of all segments.
pub fn length(segments: &[Segment<'_>]) -> usize {
    segments.iter().map(|segment| segment.len()).sum()
}

/// All segments, one after the other.
pub fn joined(segments: &[Segment<'_>]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(length(segments));
    segments.iter().for_each(|segment| bytes.extend_from_slice(segment));
    bytes
}

/// Writes all segments, one after the other.
pub fn write(segments: &[Segment<'_>], out: impl Write) -> io::Result<()> {
    // Small segments are buffered; large ones are written directly.
    let mut out = io::BufWriter::with_capacity(1 << 16, out);
    segments.iter().try_for_each(|segment| out.write_all(segment))?;
    out.flush()
}

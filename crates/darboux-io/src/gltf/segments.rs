//! Bytes to be written one after the other, each where it is already: no file is put together in memory.

use std::io::{self, Write};
use std::ops::Deref;

use super::file_bytes::FileBytes;

/// Some bytes of an output.
#[derive(Debug)]
pub enum Segment<'a> {
    /// Of the document.
    Borrowed(&'a [u8]),
    /// Made for the output.
    Owned(Vec<u8>),
    /// A whole file.
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

/// The number of bytes.
pub fn length(segments: &[Segment<'_>]) -> usize {
    segments.iter().map(|piece| piece.len()).sum()
}

/// All segments as one buffer.
pub fn joined(segments: &[Segment<'_>]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(length(segments));
    segments.iter().for_each(|piece| bytes.extend_from_slice(piece));
    bytes
}

/// Writes all segments.
pub fn write(segments: &[Segment<'_>], out: impl Write) -> io::Result<()> {
    // Small segments are gathered; large ones pass the buffer by.
    let mut out = io::BufWriter::with_capacity(1 << 16, out);
    segments.iter().try_for_each(|piece| out.write_all(piece))?;
    out.flush()
}

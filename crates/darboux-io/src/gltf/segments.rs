//! Bytes to be written one after the other, each where it is already: no file is put together in memory.

use std::io::{self, Write};
use std::ops::Deref;

use super::file_bytes::FileBytes;

/// Some bytes of an output.
#[derive(Debug)]
pub enum Piece<'a> {
    /// Of the document.
    Borrowed(&'a [u8]),
    /// Made for the output.
    Owned(Vec<u8>),
    /// A whole file.
    File(FileBytes),
}

impl Deref for Piece<'_> {
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
pub fn length(pieces: &[Piece<'_>]) -> usize {
    pieces.iter().map(|piece| piece.len()).sum()
}

/// All pieces as one buffer.
pub fn joined(pieces: &[Piece<'_>]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(length(pieces));
    pieces.iter().for_each(|piece| bytes.extend_from_slice(piece));
    bytes
}

/// Writes all pieces.
pub fn write(pieces: &[Piece<'_>], out: impl Write) -> io::Result<()> {
    // Small pieces are gathered; large ones pass the buffer by.
    let mut out = io::BufWriter::with_capacity(1 << 16, out);
    pieces.iter().try_for_each(|piece| out.write_all(piece))?;
    out.flush()
}

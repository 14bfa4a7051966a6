//! Splits a PNG into its chunks (PNG specification, third edition, section 5).

use crate::error::ContentError;
use crate::git_lfs;

/// The first bytes of every PNG.
pub const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// A chunk of a PNG.
#[derive(Clone, Copy, Debug)]
pub struct Chunk<'a> {
    pub kind: &'a [u8; 4],
    /// The whole chunk: length, kind, data and checksum.
    pub bytes: &'a [u8],
}

/// The chunks of a file. The last is IEND.
#[derive(Debug)]
pub struct Chunks<'a> {
    pub chunks: Vec<Chunk<'a>>,
    /// The bytes after IEND, which readers ignore.
    pub rest: &'a [u8],
}

impl<'a> Chunks<'a> {
    /// Splits a file into its chunks. Checksums are not checked. Errors: a file that is not a PNG, or ends
    /// within a chunk.
    pub fn split(file: &'a [u8]) -> Result<Self, ContentError> {
        let Some(mut rest) = file.strip_prefix(&SIGNATURE) else {
            let is_pointer = git_lfs::is_pointer(file);
            let problem = if is_pointer { git_lfs::NOT_AN_IMAGE } else { "is not a PNG; save it as one" };
            return Err(ContentError::invalid("", problem));
        };
        let mut chunks = Vec::new();
        loop {
            let Some((chunk, after)) = first(rest) else {
                return Err(ContentError::invalid("", "ends within a chunk; save it again"));
            };
            chunks.push(chunk);
            rest = after;
            if chunk.kind == b"IEND" {
                return Ok(Self { chunks, rest });
            }
        }
    }

    /// The chunks of one kind.
    pub fn of(&self, kind: &[u8; 4]) -> impl Iterator<Item = &Chunk<'a>> {
        self.chunks.iter().filter(move |chunk| chunk.kind == kind)
    }

    /// The number of bytes in the chunks of one kind.
    pub fn total_of(&self, kind: &[u8; 4]) -> usize {
        self.of(kind).map(|chunk| chunk.bytes.len()).sum()
    }
}

impl Chunk<'_> {
    /// The bit depth and the colour type of a header chunk.
    pub fn kind_of_texels(&self) -> Option<[u8; 2]> {
        self.bytes.get(16..18)?.try_into().ok()
    }
}

fn first(bytes: &[u8]) -> Option<(Chunk<'_>, &[u8])> {
    let (length, after) = bytes.split_first_chunk::<4>()?;
    let kind = after.first_chunk::<4>()?;
    let size = usize::try_from(u32::from_be_bytes(*length)).ok()?.checked_add(12)?;
    let (bytes, rest) = bytes.split_at_checked(size)?;
    Some((Chunk { kind, bytes }, rest))
}

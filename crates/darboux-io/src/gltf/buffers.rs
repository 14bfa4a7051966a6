//! The bytes of buffers and images: the binary chunk of a GLB, files, `data:` URIs, and new bytes of edits.

use std::path::PathBuf;
use std::sync::Arc;

use super::resources::{ResourceFile, Resources, UriTarget, decode_data_uri};
use super::schema;
use crate::error::{ContentError, system_reason};
use crate::git_lfs;

/// The source of a buffer's bytes.
#[derive(Debug)]
pub enum BufferSource {
    /// The GLB's binary chunk.
    Chunk,
    /// A file.
    File(Arc<ResourceFile>),
    /// A `data:` URI, decoded.
    Data(Vec<u8>),
    /// Decompressed bytes of a buffer that had none.
    Decoded(Vec<u8>),
    /// Bytes of edits.
    New(NewBytes),
    /// None; the clause says why, and what to do.
    Absent(&'static str),
}

/// The source of a buffer. `chunk` is the binary chunk of a GLB.
///
/// Errors: a file that cannot be read, or a source that is shorter than the buffer.
pub fn load_buffer(
    index: usize,
    buffer: &schema::Buffer,
    chunk: Option<&[u8]>,
    resources: &mut Resources,
) -> Result<BufferSource, ContentError> {
    let at = || format!("buffers[{index}].uri");
    let store = match buffer.uri.as_deref().map(|uri| resources.resolve(uri)) {
        None if index == 0 && chunk.is_some() => BufferSource::Chunk,
        None => return Ok(BufferSource::Absent("has no bytes; export the file again")),
        Some(Ok(UriTarget::Remote)) => {
            return Ok(BufferSource::Absent("is on another machine; download it and refer to the file"));
        }
        Some(Ok(UriTarget::Data(data))) => {
            BufferSource::Data(decode_data_uri(data).map_err(|problem| ContentError::invalid(at(), problem))?)
        }
        Some(Ok(UriTarget::File(located))) => {
            let file = resources.open(&located);
            BufferSource::File(file.map_err(|error| {
                ContentError::resource(at(), format!("cannot be read: {}", system_reason(&error)))
            })?)
        }
        Some(Err(problem)) => return Err(ContentError::resource(at(), problem)),
    };
    if let BufferSource::File(file) = &store
        && git_lfs::is_pointer(&file.bytes)
    {
        return Err(ContentError::resource(at(), git_lfs::NOT_THE_FILE));
    }
    let available = match &store {
        BufferSource::File(file) => file.bytes.len(),
        BufferSource::Data(bytes) => bytes.len(),
        _ => chunk.unwrap_or_default().len(),
    };
    if buffer.byte_length > available {
        let problem =
            format!("is {} but there are {available} bytes; export the file again", buffer.byte_length);
        return Err(ContentError::invalid(format!("buffers[{index}].byteLength"), problem));
    }
    Ok(store)
}

/// The bytes of edits: one piece per buffer view.
#[derive(Debug, Default)]
pub struct NewBytes {
    /// The pieces and their offsets, in ascending order.
    pieces: Vec<(usize, Vec<u8>)>,
    length: usize,
}

impl NewBytes {
    /// Appends a piece at the next multiple of four. Returns its offset.
    pub fn push(&mut self, bytes: Vec<u8>) -> usize {
        let offset = self.length.next_multiple_of(4);
        self.length = offset + bytes.len();
        self.pieces.push((offset, bytes));
        offset
    }

    /// The number of bytes with the padding between pieces.
    pub fn len(&self) -> usize {
        self.length
    }

    /// A range of bytes; none if it is not within one piece.
    pub fn range(&self, offset: usize, length: usize) -> Option<&[u8]> {
        let after = self.pieces.partition_point(|(start, _)| *start <= offset);
        let (start, bytes) = self.pieces.get(after.checked_sub(1)?)?;
        let from = offset - start;
        bytes.get(from..from.checked_add(length)?)
    }

    /// Drops all pieces from an offset on.
    pub fn truncate(&mut self, length: usize) {
        let kept = self.pieces.partition_point(|(start, _)| *start < length);
        self.pieces.truncate(kept);
        self.length = length;
    }
}

/// The new content of an image that is a file.
#[derive(Clone, Debug)]
pub struct ImageFile {
    /// The path relative to the document's folder.
    pub relative: PathBuf,
    pub bytes: Vec<u8>,
    pub media_type: String,
}

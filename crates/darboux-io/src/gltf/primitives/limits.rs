//! Small files that ask for much: accessors over the same bytes, again and again.

use crate::Error;
use crate::gltf::Document;

/// How many corners, or bytes written, each byte of a document may ask for. Real ones stay below 4, however much they share.
const MOST_PER_BYTE: usize = 16;

/// What a document of any size may ask for.
const ALWAYS_ALLOWED: usize = 1 << 20;

fn limit(document: &Document) -> usize {
    document.stored_bytes().saturating_mul(MOST_PER_BYTE).saturating_add(ALWAYS_ALLOWED)
}

/// Errors: more corners in all these triangles than the document has room for.
pub fn check_triangles(document: &Document, mut counts: impl Iterator<Item = usize>) -> Result<(), Error> {
    let corners = counts.try_fold(0usize, |sum, count| sum.checked_add(count.checked_mul(3)?));
    if corners.unwrap_or(usize::MAX) <= limit(document) { Ok(()) } else { Err(refused(document)) }
}

/// Errors: more bytes written than the document's size explains.
pub fn check_output(document: &Document) -> Result<(), Error> {
    check_more_output(document, 0)
}

/// As [`check_output`], with bytes that are yet to be written.
pub fn check_more_output(document: &Document, bytes: usize) -> Result<(), Error> {
    let written = document.edits.new_byte_count.saturating_add(bytes);
    if written <= limit(document) { Ok(()) } else { Err(refused(document)) }
}

fn refused(document: &Document) -> Error {
    let problem = "so many accessors read the same bytes that what is computed would dwarf the file; export the file again";
    document.invalid("accessors", problem)
}

//! Checks of memory before corners are computed and bytes are written.
//!
//! Accessors may read the same bytes again and again, so that a small file can ask for any amount of work.

use crate::Error;
use crate::error::ContentError;
use crate::gltf::Document;
use crate::memory_limit::BYTES_PER_CORNER;

/// Checks the corners of triangles that are to be computed, given as triangles per primitive.
///
/// Errors: their computation needs more than the memory limit.
pub fn check_triangles(document: &Document, counts: impl Iterator<Item = usize>) -> Result<(), Error> {
    let triangles = counts.fold(0, usize::saturating_add);
    check(document, triangles.saturating_mul(3 * BYTES_PER_CORNER), "have so many corners that they need")
}

/// Checks the matrices that accessors hold, given in ascending order. Errors: they take more than the memory
/// limit.
pub fn check_matrices(document: &Document, accessors: impl Iterator<Item = usize>) -> Result<(), Error> {
    let (mut last, mut matrices) = (None, 0usize);
    for accessor in accessors.filter(|accessor| last.replace(*accessor) != Some(*accessor)) {
        matrices = matrices.saturating_add(document.accessors().get(accessor).map_or(0, |found| found.count));
    }
    check(document, matrices.saturating_mul(size_of::<[f32; 16]>()), "have so many matrices that they need")
}

/// Checks the number of UVs that are to be kept, all sets together. Errors: they take more than the memory
/// limit.
pub fn check_uvs(document: &Document, uvs: usize) -> Result<(), Error> {
    check(document, uvs.saturating_mul(size_of::<[f32; 2]>()), "have so many UVs that they need")
}

/// Checks the bytes that are to be written. Errors: they are more than the memory limit.
pub fn check_output(document: &Document) -> Result<(), Error> {
    check_more_output(document, 0)
}

/// As [`check_output`], with bytes that have not been added to the document yet.
pub fn check_more_output(document: &Document, bytes: usize) -> Result<(), Error> {
    let written = document.new_byte_count().saturating_add(bytes);
    check(document, written, "share bytes so often that the result needs")
}

fn check(document: &Document, bytes: usize, what: &str) -> Result<(), Error> {
    let limit = document.memory_limit();
    if bytes <= limit.bytes {
        return Ok(());
    }
    Err(ContentError::unsupported("accessors", limit.exceeded(what)).in_file(document.name()))
}

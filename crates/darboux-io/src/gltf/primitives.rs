//! What tangents, normals, conversion, inspection and comparison share about primitives.

pub mod append;
pub mod canonical;
pub mod corners;
pub mod foreign_extensions;
pub mod index_range;
pub mod limits;
pub mod name;
pub mod offsets;
pub mod quads;
pub mod triangles;
pub mod used_vertices;

use super::Document;
use crate::Error;

/// The number of elements of an accessor that something refers to.
pub fn element_count(document: &Document, accessor: usize) -> Result<usize, Error> {
    match document.accessors().get(accessor) {
        Some(accessor) => Ok(accessor.count),
        None => {
            Err(document.invalid(format!("accessors[{accessor}]"), "does not exist; export the file again"))
        }
    }
}

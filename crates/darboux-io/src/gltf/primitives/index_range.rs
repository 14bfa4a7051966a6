//! Checks that indices name vertices, for operations that write primitives without computing on their
//! triangles.

use std::collections::HashSet;

use super::element_count;
use crate::Error;
use crate::gltf::{Document, IndexList};

/// Checks each pair of indices and number of vertices once.
#[derive(Debug, Default)]
pub struct IndexRanges {
    checked: HashSet<(usize, usize)>,
}

impl IndexRanges {
    /// Errors: an index of the primitive is not below its number of vertices; the indices cannot be read.
    pub fn check(&mut self, document: &Document, mesh: usize, place: usize) -> Result<(), Error> {
        let primitive = &document.meshes()[mesh].primitives[place];
        let (Some(accessor), Some(&position)) = (primitive.indices, primitive.attributes.get("POSITION"))
        else {
            return Ok(());
        };
        let vertices = element_count(document, position)?;
        if !self.checked.insert((accessor, vertices)) {
            return Ok(());
        }
        let found = match document.indices(accessor)? {
            IndexList::U16(indices) => first_outside(&indices, vertices),
            IndexList::U32(indices) => first_outside(&indices, vertices),
        };
        match found {
            None => Ok(()),
            Some((at, index)) => {
                let path = format!("meshes[{mesh}].primitives[{place}]");
                Err(document.mesh_error(path, darboux::Error::IndexOutOfRange { at, index, vertices }))
            }
        }
    }
}

/// The first index that is not below `vertices`, after its place.
fn first_outside<I: Copy + Into<u32>>(indices: &[I], vertices: usize) -> Option<(usize, u32)> {
    let at = indices.iter().position(|&index| index.into() as usize >= vertices)?;
    Some((at, indices[at].into()))
}

//! Checks that attributes have one element per vertex and that indices name vertices, for operations that write primitives without computing
//! on their triangles.

use std::collections::HashSet;

use super::element_count;
use crate::Error;
use crate::gltf::{Document, IndexList};

/// Checks primitives; each pair of indices and number of vertices once.
#[derive(Debug, Default)]
pub struct VertexCheck {
    checked: HashSet<(usize, usize)>,
}

impl VertexCheck {
    /// Errors: an attribute has another number of elements than the positions; an index is not below this number; the indices cannot be
    /// read.
    pub fn check(&mut self, document: &Document, mesh: usize, place: usize) -> Result<(), Error> {
        let primitive = &document.meshes()[mesh].primitives[place];
        let Some(&position) = primitive.attributes.get("POSITION") else { return Ok(()) };
        let path = format!("meshes[{mesh}].primitives[{place}]");
        let vertices = element_count(document, position)?;
        for (name, &accessor) in &primitive.attributes {
            let count = element_count(document, accessor)?;
            if count != vertices {
                let problem =
                    format!("has {count} elements but there are {vertices} positions; export the file again");
                return Err(document.invalid(format!("{path}.attributes.{name}"), problem));
            }
        }
        match primitive.indices {
            Some(indices) => self.check_indices(document, &path, indices, vertices),
            None => Ok(()),
        }
    }

    fn check_indices(
        &mut self,
        document: &Document,
        path: &str,
        accessor: usize,
        vertices: usize,
    ) -> Result<(), Error> {
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

//! Appends vertices to the attributes of primitives. Existing accessors are never changed: longer copies take
//! their place.

use std::collections::HashMap;

use crate::json::Value;

use super::canonical::CanonicalAccessors;
use super::limits;
use crate::Error;
use crate::gltf::schema::Attributes;
use crate::gltf::{ComponentType, Document, ElementType, Elements, NewAccessor, Target};

/// Accessors with appended vertices, each made on first use.
#[derive(Debug)]
pub struct Appended<'a> {
    accessors: &'a CanonicalAccessors,
    copies: &'a [u32],
    old_count: usize,
    /// The new accessors, by the old one and whether it has bounds.
    made: HashMap<(usize, bool), usize>,
}

impl<'a> Appended<'a> {
    /// `copies` has the old vertex, below `old_count`, that each appended vertex is a copy of.
    pub fn new(accessors: &'a CanonicalAccessors, copies: &'a [u32], old_count: usize) -> Self {
        Self { accessors, copies, old_count, made: HashMap::new() }
    }

    /// Whether there are vertices to append.
    pub fn is_needed(&self) -> bool {
        !self.copies.is_empty()
    }

    /// The number of old vertices.
    pub fn old_count(&self) -> usize {
        self.old_count
    }

    /// An accessor with the elements of `old` and of the appended vertices, bit for bit. `at` is the JSON
    /// path that refers to `old`.
    ///
    /// Errors: the accessor does not exist, or does not have one element per vertex.
    pub fn accessor(
        &mut self,
        document: &mut Document,
        at: &str,
        old: usize,
        bounds: bool,
    ) -> Result<usize, Error> {
        let key = (self.accessors.of(old), bounds);
        if let Some(&made) = self.made.get(&key) {
            return Ok(made);
        }
        let mut elements = document.elements(old)?;
        if elements.count != self.old_count {
            let problem =
                format!("accessor {old} has {} elements for {} vertices", elements.count, self.old_count);
            return Err(document.invalid(at, format!("{problem}; export the file again")));
        }
        self.extend(&mut elements);
        let sparse = lacks_buffer_view(document, old);
        let new = NewAccessor::new(elements, Target::Vertices)
            .with_bounds(bounds)
            .with_sparse(sparse)
            .with_metadata_of(Some(old));
        let made = document.push_accessor(new);
        limits::check_output(document)?;
        self.made.insert(key, made);
        Ok(made)
    }

    fn extend(&self, elements: &mut Elements) {
        let size = elements.element_size();
        elements.bytes.reserve_exact(self.copies.len() * size);
        for &source in self.copies {
            let start = source as usize * size;
            elements.bytes.extend_from_within(start..start + size);
        }
        elements.count += self.copies.len();
    }
}

/// Appends an accessor of floats, one element per vertex, sparse if that is permitted and shorter. Returns
/// `old` if it has the same elements.
pub fn push_vectors<const N: usize>(
    document: &mut Document,
    old: Option<usize>,
    element_type: ElementType,
    vectors: &[[f32; N]],
    sparse: bool,
) -> usize {
    let elements = Elements {
        bytes: vectors.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect(),
        count: vectors.len(),
        component_type: ComponentType::F32,
        element_type,
        normalized: false,
    };
    let target = Target::Vertices;
    document.push_in_place_of(old, NewAccessor::new(elements, target).with_sparse(sparse))
}

/// Whether an accessor has no buffer view, so that its copies should be sparse too.
pub fn lacks_buffer_view(document: &Document, accessor: usize) -> bool {
    document.accessors().get(accessor).is_some_and(|accessor| accessor.buffer_view.is_none())
}

/// Sets the attributes in a JSON object.
pub fn set_attributes(json: Option<&mut Value>, attributes: &Attributes) {
    let Some(json) = json.and_then(Value::as_object_mut) else { return };
    for (semantic, &accessor) in attributes {
        json.insert(semantic, accessor.into());
    }
}

/// An index list of the old component type, or the next larger one that holds all indices; of at least 16
/// bits if there was none.
///
/// The greatest number of a type is not a valid index: it restarts primitives (glTF 2.0, 3.7.2.1).
pub fn index_elements(old: Option<ComponentType>, indices: Vec<u32>) -> Elements {
    let greatest = indices.iter().copied().max().unwrap_or(0);
    let least = match old {
        Some(ComponentType::U8) => 1,
        Some(ComponentType::U32) => 4,
        _ => 2,
    };
    let (component_type, bytes) = if least <= 1 && greatest < 0xff {
        (ComponentType::U8, indices.iter().map(|&index| index as u8).collect())
    } else if least <= 2 && greatest < 0xffff {
        (ComponentType::U16, indices.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect())
    } else {
        (ComponentType::U32, indices.iter().flat_map(|&index| index.to_le_bytes()).collect())
    };
    Elements {
        bytes,
        count: indices.len(),
        component_type,
        element_type: ElementType::Scalar,
        normalized: false,
    }
}

#[cfg(test)]
mod tests {
    use super::{ComponentType, index_elements};

    #[test]
    fn indices_widen_before_the_restart_value() {
        use ComponentType::{U8, U16, U32};
        let cases = [
            (Some(U8), 254, U8),
            (Some(U8), 255, U16),
            (Some(U8), 65534, U16),
            (Some(U8), 65535, U32),
            (Some(U16), 3, U16),
            (Some(U16), 65535, U32),
            (Some(U32), 3, U32),
            (None, 254, U16),
            (None, 65535, U32),
        ];
        for (old, greatest, new) in cases {
            let elements = index_elements(old, vec![0, greatest]);
            assert_eq!(elements.component_type, new, "{old:?} {greatest}");
            assert_eq!(elements.bytes.len(), 2 * new.size());
        }
    }
}

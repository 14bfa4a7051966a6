//! Finds accessors that read the same bytes in the same way.

use std::collections::HashMap;

use crate::gltf::Document;
use crate::gltf::schema::Accessor;

/// The first of all accessors that read the same bytes in the same way. Some exporters write one per
/// primitive.
#[derive(Debug)]
pub struct CanonicalAccessors(Vec<usize>);

impl CanonicalAccessors {
    /// Compares all accessors of a document.
    pub fn new(document: &Document) -> Self {
        let mut first = HashMap::new();
        let accessors = document.accessors().iter().enumerate();
        Self(accessors.map(|(index, accessor)| *first.entry(reading(accessor)).or_insert(index)).collect())
    }

    /// The first accessor that reads the same as `accessor`; `accessor` itself if it does not exist.
    pub fn of(&self, accessor: usize) -> usize {
        self.0.get(accessor).copied().unwrap_or(accessor)
    }
}

/// Everything that decides which values an accessor reads.
fn reading(accessor: &Accessor) -> impl Eq + std::hash::Hash {
    let sparse = accessor.sparse.as_deref().map(|sparse| {
        let (indices, values) = (&sparse.indices, &sparse.values);
        let places = (indices.buffer_view, indices.byte_offset, indices.component_type.code());
        (sparse.count, places, values.buffer_view, values.byte_offset)
    });
    let element = (accessor.element_type.name(), accessor.component_type.code(), accessor.normalized);
    (accessor.buffer_view, accessor.byte_offset, accessor.count, element, sparse)
}

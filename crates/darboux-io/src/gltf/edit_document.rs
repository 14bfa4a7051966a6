//! Edits a document: appends accessors and buffer views, and replaces the JSON of primitives.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::value::RawValue;
use serde_json::{Map, Value};

use super::document::Document;
use super::edits::NewView;
use super::element_type::ComponentType;
use super::elements::{Elements, NewAccessor, Target};
use super::json_text;
use super::primitives::append::index_elements;
use super::schema;
use crate::Error;

impl Document {
    /// Appends an accessor with new buffer views. Returns its index.
    ///
    /// Panics if `new.elements.bytes` does not have the length of `count` elements.
    pub fn push_accessor(&mut self, new: NewAccessor) -> usize {
        let source = new.metadata_of.and_then(|index| self.root.accessors.get(index)).cloned();
        let bounds = new.bounds.then(|| new.elements.bounds()).flatten();
        let stored = self.store(new);
        self.edits.new_accessors.push(stored.to_json(bounds, source.as_ref()));
        if let Some(backed) = self.backed_count.get_mut() {
            *backed = (*backed).max(stored.count);
        }
        self.root.accessors.push(stored);
        self.root.accessors.len() - 1
    }

    /// Replaces the triangles of a primitive by others over the same vertices; strips and fans become lists.
    ///
    /// `corners`: the vertices of the triangles, three per triangle. Indices after the last complete triangle are dropped. Errors: no such
    /// primitive.
    pub fn set_triangles(&mut self, mesh: usize, primitive: usize, corners: Vec<u32>) -> Result<(), Error> {
        let stored = self.root.meshes.get(mesh).and_then(|mesh| mesh.primitives.get(primitive));
        let old = stored.and_then(|primitive| primitive.indices);
        let kind = old.and_then(|old| self.root.accessors.get(old)).map(|old| old.component_type);
        let elements = index_elements(kind, corners);
        let new = NewAccessor::new(elements, Target::Indices).with_metadata_of(old);
        let indices = self.push_in_place_of(old, new);
        self.edit_primitive(mesh, primitive, |json| {
            json.insert("indices".to_owned(), indices.into());
            if json.get("mode").is_some_and(|mode| mode != 4) {
                json.insert("mode".to_owned(), 4.into());
            }
        })
    }

    /// As [`Document::push_accessor`], unless the accessor `old`, which `new` would replace, has the same elements: then `old` is
    /// kept. A second run with the same result thus stores nothing new.
    pub(super) fn push_in_place_of(&mut self, old: Option<usize>, new: NewAccessor) -> usize {
        let is_same = |&old: &usize| self.find_elements(old).is_ok_and(|elements| elements == new.elements);
        match old.filter(is_same) {
            Some(old) => old,
            None => self.push_accessor(new),
        }
    }

    /// Stores the elements of `new` in new buffer views.
    fn store(&mut self, new: NewAccessor) -> schema::Accessor {
        let elements = new.elements;
        let size = elements.element_size();
        assert_eq!(elements.bytes.len(), elements.count * size, "bytes are not whole elements");
        let places = new.sparse.then(|| elements.sparse_indices()).flatten();
        let (buffer_view, sparse) = match places {
            Some(places) if places.is_empty() => (None, None),
            Some(places) => (None, Some(Box::new(self.push_sparse(&elements, &places)))),
            None => {
                let stride = new.target.stride(size);
                (Some(self.push_view(elements.bytes, size, stride, Some(new.target))), None)
            }
        };
        schema::Accessor {
            buffer_view,
            byte_offset: 0,
            component_type: elements.component_type,
            normalized: elements.normalized,
            count: elements.count,
            element_type: elements.element_type,
            sparse,
            name: None,
            extras: None,
            extensions: None,
        }
    }

    fn push_sparse(&mut self, elements: &Elements, places: &[u32]) -> schema::Sparse {
        let size = elements.element_size();
        let indices: Vec<_> = places.iter().flat_map(|place| place.to_le_bytes()).collect();
        let values: Vec<_> = places
            .iter()
            .flat_map(|&place| &elements.bytes[place as usize * size..(place as usize + 1) * size])
            .copied()
            .collect();
        let indices = schema::SparseIndices {
            buffer_view: self.push_view(indices, 4, 4, None),
            byte_offset: 0,
            component_type: ComponentType::U32,
        };
        let values =
            schema::SparseValues { buffer_view: self.push_view(values, size, size, None), byte_offset: 0 };
        schema::Sparse { count: places.len(), indices, values }
    }

    /// Appends a buffer view of elements of `size` bytes, `stride` bytes apart. Returns its index.
    pub(super) fn push_view(
        &mut self,
        bytes: Vec<u8>,
        size: usize,
        stride: usize,
        target: Option<Target>,
    ) -> usize {
        let view = if stride == size {
            NewView { bytes, stride: None, target }
        } else {
            let mut spread = vec![0; bytes.len() / size * stride];
            for (slot, element) in spread.chunks_exact_mut(stride).zip(bytes.chunks_exact(size)) {
                slot[..size].copy_from_slice(element);
            }
            NewView { bytes: spread, stride: Some(stride), target }
        };
        self.edits.new_byte_count += view.bytes.len();
        self.edits.new_views.push(view);
        self.root.buffer_views.len() + self.edits.new_views.len() - 1
    }

    /// Edits a primitive.
    ///
    /// The map holds the members `attributes`, `indices`, `material`, `mode` and `targets`. Other members, and those that `edit` leaves
    /// equal, keep their spelling. Errors: no such primitive; a result that is not a primitive.
    pub fn edit_primitive(
        &mut self,
        mesh: usize,
        primitive: usize,
        edit: impl FnOnce(&mut Map<String, Value>),
    ) -> Result<(), Error> {
        let at = || format!("meshes[{mesh}].primitives[{primitive}]");
        let text = self
            .primitive_text(mesh, primitive)
            .ok_or_else(|| self.invalid(at(), "does not exist; name one of the document"))?;
        let edited = edited_primitive(text, edit).map_err(|error| self.invalid(at(), error.to_string()))?;
        self.replace_primitive(mesh, primitive, edited)
            .map_err(|error| self.invalid(at(), format!("the edit is not a primitive: {error}")))
    }

    /// Declares extensions that readers must support, unless they are declared already.
    pub(super) fn require_extensions(&mut self, names: impl IntoIterator<Item = &'static str>) {
        for name in names {
            if !self.edits.required_extensions.contains(&name) {
                self.edits.required_extensions.push(name);
            }
        }
    }

    /// The JSON of a primitive, edits included.
    pub(super) fn primitive_text(&self, mesh: usize, primitive: usize) -> Option<&str> {
        if let Some(edited) = self.edits.primitives.get(&(mesh, primitive)) {
            return Some(edited);
        }
        let texts = self.primitive_texts.get_or_init(|| split_primitives(self.text()));
        Some(texts.get(mesh)?.get(primitive)?.get())
    }

    /// Sets the JSON of an existing primitive, unless it is the same.
    pub(super) fn replace_primitive(
        &mut self,
        mesh: usize,
        primitive: usize,
        text: String,
    ) -> serde_json::Result<()> {
        if self.primitive_text(mesh, primitive) == Some(&text) {
            return Ok(());
        }
        let replaced: schema::Primitive = serde_json::from_str(&text)?;
        let replaced = std::mem::replace(&mut self.root.meshes[mesh].primitives[primitive], replaced);
        let attributes = replaced.targets.iter().chain([&replaced.attributes]).flat_map(BTreeMap::values);
        self.edits.formerly_referenced.extend(attributes.chain(&replaced.indices));
        self.edits.primitives.insert((mesh, primitive), text);
        Ok(())
    }
}

/// The JSON text of every primitive of every mesh.
fn split_primitives(text: &str) -> Vec<Vec<Box<RawValue>>> {
    #[derive(Deserialize)]
    struct Meshes {
        #[serde(default)]
        meshes: Vec<Primitives>,
    }
    #[derive(Deserialize)]
    struct Primitives {
        primitives: Vec<Box<RawValue>>,
    }
    let parsed: serde_json::Result<Meshes> = serde_json::from_str(text);
    // The same text was parsed more strictly when the document was read.
    let meshes = parsed.map(|parsed| parsed.meshes).unwrap_or_default();
    meshes.into_iter().map(|mesh| mesh.primitives).collect()
}

fn edited_primitive(text: &str, edit: impl FnOnce(&mut Map<String, Value>)) -> serde_json::Result<String> {
    const KNOWN_MEMBERS: [&str; 5] = ["attributes", "indices", "material", "mode", "targets"];
    let mut before = Map::new();
    for key in KNOWN_MEMBERS {
        if let Some(value) = json_text::member(text, key)? {
            before.insert(key.to_owned(), serde_json::from_str(value)?);
        }
    }
    let mut after = before.clone();
    edit(&mut after);
    let mut text = text.to_owned();
    for key in before.keys().filter(|key| !after.contains_key(*key)) {
        text = json_text::set_member(&text, key, None)?;
    }
    for (key, value) in after.iter().filter(|&(key, value)| before.get(key) != Some(value)) {
        text = json_text::set_member(&text, key, Some(&value.to_string()))?;
    }
    Ok(text)
}

//! Edits of documents. Every edit changes the JSON and renews the typed part that it changes, so that readers
//! see one document.
//!
//! ```text
//! edit              elements of arrays, new data
//! edit/primitives   attributes, triangles and other members of primitives
//! edit/vertices     positions, normals and tangents of primitives
//! edit/images       the content of images
//! edit/materials    normal maps and colours of materials
//! edit/checkpoint   takes edits back
//! ```

mod checkpoint;
mod images;
pub mod materials;
mod primitives;
mod vertices;

pub use checkpoint::Checkpoint;

use std::sync::PoisonError;

use crate::json::{Map, Value, object};

use super::buffers::{BufferSource, NewBytes};
use super::document::Document;
use super::element_type::{ComponentType, ElementType};
use super::elements::{NewAccessor, Target};
use super::schema::{self, Root};
use crate::error::ContentError;
use crate::json;

impl Document {
    /// Appends an accessor with new buffer views. Returns its index. It is written if something refers to it
    /// then.
    ///
    /// Panics if `new.elements.bytes` does not have the length of `count` elements.
    pub fn push_accessor(&mut self, new: NewAccessor) -> usize {
        let description = new.metadata_of.map(|index| self.element("accessors", index).clone());
        let bounds = new.bounds.then(|| new.elements.bounds()).flatten();
        let stored = self.store(new);
        let mut element = stored.to_json(bounds);
        for key in ["name", "extras", "extensions"] {
            if let Some(value) = description.as_ref().and_then(|description| description.get(key)) {
                element.insert(key, value.clone());
            }
        }
        if let Some(backed) = self.backed_count.get_mut() {
            *backed = (*backed).max(stored.count);
        }
        self.push_element("accessors", Value::Object(element))
    }

    /// As [`Document::push_accessor`], unless the accessor `old`, which `new` would replace, has the same
    /// elements: then `old` is kept. A second run with the same result thus stores nothing new.
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
            Some(places) => {
                let values = places.iter().flat_map(|&place| {
                    elements.bytes[place as usize * size..(place as usize + 1) * size].iter().copied()
                });
                (None, self.push_sparse(&places, values.collect(), size))
            }
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
        }
    }

    /// Appends an accessor of vectors that are zero but for those at some places, ascending. Returns its
    /// index. The time does not depend on `count`.
    pub(super) fn push_few_vectors(&mut self, count: usize, vectors: &[(u32, [f32; 3])]) -> usize {
        let places: Vec<u32> = vectors.iter().map(|(place, _)| *place).collect();
        let values = vectors.iter().flat_map(|(_, vector)| vector.iter().flat_map(|x| x.to_le_bytes()));
        let sparse = self.push_sparse(&places, values.collect(), size_of::<[f32; 3]>());
        let stored = schema::Accessor {
            buffer_view: None,
            byte_offset: 0,
            component_type: ComponentType::F32,
            normalized: false,
            count,
            element_type: ElementType::Vec3,
            sparse,
        };
        let element = stored.to_json(None);
        self.push_element("accessors", Value::Object(element))
    }

    /// The sparse elements of an accessor without others; none where there are none.
    fn push_sparse(&mut self, places: &[u32], values: Vec<u8>, size: usize) -> Option<Box<schema::Sparse>> {
        if places.is_empty() {
            return None;
        }
        let indices: Vec<_> = places.iter().flat_map(|place| place.to_le_bytes()).collect();
        let indices = schema::SparseIndices {
            buffer_view: self.push_view(indices, 4, 4, None),
            byte_offset: 0,
            component_type: ComponentType::U32,
        };
        let values =
            schema::SparseValues { buffer_view: self.push_view(values, size, size, None), byte_offset: 0 };
        Some(Box::new(schema::Sparse { count: places.len(), indices, values }))
    }

    /// Appends a buffer view of elements of `size` bytes, `stride` bytes apart. Returns its index.
    pub(super) fn push_view(
        &mut self,
        bytes: Vec<u8>,
        size: usize,
        stride: usize,
        target: Option<Target>,
    ) -> usize {
        let bytes = if stride == size { bytes } else { spread(&bytes, size, stride) };
        let byte_length = bytes.len();
        let (buffer, byte_offset) = self.push_bytes(bytes);
        let mut element = Map::default();
        element.insert("buffer", buffer.into());
        element.insert("byteOffset", byte_offset.into());
        element.insert("byteLength", byte_length.into());
        if stride != size {
            element.insert("byteStride", stride.into());
        }
        if let Some(code) = target.and_then(Target::code) {
            element.insert("target", code.into());
        }
        self.push_element("bufferViews", Value::Object(element))
    }

    /// Appends bytes to the buffer of new bytes, which is made on first use. Returns the buffer and the
    /// offset.
    fn push_bytes(&mut self, bytes: Vec<u8>) -> (usize, usize) {
        if !matches!(self.buffers.last(), Some(BufferSource::New(_))) {
            self.buffers.push(BufferSource::New(NewBytes::default()));
            self.push_element("buffers", object! { "byteLength": 0usize });
        }
        let buffer = self.buffers.len() - 1;
        let Some(BufferSource::New(new)) = self.buffers.last_mut() else { unreachable!("was pushed") };
        let offset = new.push(bytes);
        self.set_new_length();
        (buffer, offset)
    }

    /// Stores the length of the buffer of new bytes.
    fn set_new_length(&mut self) {
        let buffer = self.buffers.len() - 1;
        let length = self.new_byte_count();
        self.root.buffers[buffer].byte_length = length;
        if let Some(stored) =
            self.json.get_mut("buffers").and_then(|buffers| buffers[buffer].get_mut("byteLength"))
        {
            *stored = length.into();
        }
    }

    /// The number of bytes of edits.
    pub(super) fn new_byte_count(&self) -> usize {
        match self.buffers.last() {
            Some(BufferSource::New(new)) => new.len(),
            _ => 0,
        }
    }

    /// Appends an element to an array of the root object. Returns its index.
    fn push_element(&mut self, array: &'static str, element: Value) -> usize {
        self.is_changed = true;
        if self.json[array].as_array().is_none() {
            self.json[array] = Value::Array(Vec::new());
        }
        let Value::Array(elements) = &mut self.json[array] else { unreachable!("is an array") };
        let index = elements.len();
        let read = self.root.renew(array, index, &element);
        read.unwrap_or_else(|error| unreachable!("an edit wrote what cannot be read: {error:?}"));
        elements.push(element);
        index
    }

    /// Edits an element of an array of the root object. Returns whether it changed.
    ///
    /// Errors: the result cannot be read; then the element stays as it was.
    pub(super) fn edit_element(
        &mut self,
        array: &'static str,
        index: usize,
        edit: impl FnOnce(&mut Value),
    ) -> Result<bool, ContentError> {
        let Some(stored) = self.json.get_mut(array).and_then(|elements| elements.get_mut(index)) else {
            return Err(ContentError::invalid(format!("{array}[{index}]"), "does not exist"));
        };
        let mut edited = stored.clone();
        edit(&mut edited);
        if edited == *stored {
            return Ok(false);
        }
        self.root.renew(array, index, &edited)?;
        *stored = edited;
        self.is_changed = true;
        if ["accessors", "bufferViews", "buffers"].contains(&array) {
            self.forget_checked_sparse();
        }
        Ok(true)
    }

    /// Sparse indices are looked through again: their accessors or bytes may be other ones now.
    pub(super) fn forget_checked_sparse(&mut self) {
        self.checked_sparse.get_mut().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// Whether the typed parts are what the JSON says. Every edit keeps this; builds with debug assertions
    /// check it whenever a document is written.
    pub(super) fn agrees_with_its_json(&self) -> bool {
        json::read::<Root>(&self.json, "").is_ok_and(|root| root == self.root)
    }

    /// Declares extensions that readers must support, unless they are declared already.
    pub(super) fn require_extensions(&mut self, names: impl IntoIterator<Item = &'static str>) {
        for name in names {
            self.declare_extension("extensionsRequired", name);
            self.use_extension(name);
        }
    }

    /// Declares an extension that readers may do without, unless it is declared already.
    pub(super) fn use_extension(&mut self, name: &'static str) {
        self.declare_extension("extensionsUsed", name);
    }

    fn declare_extension(&mut self, list: &'static str, name: &'static str) {
        let declared = self.json[list].as_array();
        if !declared.is_some_and(|declared| declared.iter().any(|declared| declared == name)) {
            self.push_element(list, name.into());
        }
    }

    /// Removes the declarations of extensions that the document no longer has.
    pub(super) fn undeclare_extensions(&mut self, names: &[&str]) {
        let Some(root) = self.json.as_object_mut() else { return };
        for list in ["extensionsUsed", "extensionsRequired"] {
            let Some(Value::Array(declared)) = root.get_mut(list) else { continue };
            let count = declared.len();
            declared.retain(|declared| !names.iter().any(|name| declared == name));
            self.is_changed |= declared.len() < count;
            if declared.is_empty() {
                root.remove(list);
            }
        }
    }
}

impl Root {
    /// Reads an element whose JSON is new or has changed, if it is one of the typed parts. Errors: it cannot
    /// be read.
    fn renew(&mut self, array: &'static str, index: usize, element: &Value) -> Result<(), ContentError> {
        let at = format!("{array}[{index}]");
        match array {
            "meshes" => put(&mut self.meshes, index, json::read(element, &at)?),
            "accessors" => put(&mut self.accessors, index, json::read(element, &at)?),
            "bufferViews" => put(&mut self.buffer_views, index, json::read(element, &at)?),
            "buffers" => put(&mut self.buffers, index, json::read(element, &at)?),
            "images" => put(&mut self.images, index, json::read(element, &at)?),
            "materials" => put(&mut self.materials, index, json::read(element, &at)?),
            _ => {}
        }
        Ok(())
    }
}

/// Replaces an element, or appends it.
fn put<T>(elements: &mut Vec<T>, index: usize, element: T) {
    if index == elements.len() { elements.push(element) } else { elements[index] = element }
}

/// Elements of `size` bytes, moved `stride` bytes apart.
fn spread(bytes: &[u8], size: usize, stride: usize) -> Vec<u8> {
    let mut spread = vec![0; bytes.len() / size * stride];
    for (slot, element) in spread.chunks_exact_mut(stride).zip(bytes.chunks_exact(size)) {
        slot[..size].copy_from_slice(element);
    }
    spread
}

#[cfg(test)]
mod tests {
    use crate::LoadOptions;
    use crate::gltf::Document;

    /// Sparse indices are looked through once; an edit, and its taking back, make that outdated.
    #[test]
    fn sparse_indices_are_looked_through_again_after_edits() {
        // 24 bytes of values, then 1, 2, 1: the view 1 ascends, the view 2 does not.
        let data = format!("data:application/octet-stream;base64,{}AQIB", "A".repeat(32));
        let text = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":27,"uri":"{data}"}}],"bufferViews":[
            {{"buffer":0,"byteLength":24}},{{"buffer":0,"byteOffset":24,"byteLength":2}},
            {{"buffer":0,"byteOffset":25,"byteLength":2}}],"accessors":[{{"componentType":5126,"count":4,
            "type":"VEC3","sparse":{{"count":2,"indices":{{"bufferView":2,"componentType":5121}},
            "values":{{"bufferView":0}}}}}}]}}"#
        );
        let document = Document::from_bytes("m.gltf", text.into_bytes(), None, &LoadOptions::default());
        let mut document = document.expect("a document");
        let is_refused = |document: &Document| {
            let read = document.vectors_at::<3>(0, &[1, 2]);
            read.is_err_and(|error| error.to_string().contains("accessors[0].sparse.indices"))
        };
        let take = |document: &mut Document, view: usize| {
            let edited = document.edit_element("accessors", 0, |accessor| {
                accessor["sparse"]["indices"]["bufferView"] = view.into();
            });
            assert_eq!(edited.ok(), Some(true));
        };
        assert!(is_refused(&document));
        let checkpoint = document.checkpoint();
        take(&mut document, 1);
        assert!(!is_refused(&document));
        take(&mut document, 2);
        assert!(is_refused(&document));
        take(&mut document, 1);
        assert!(!is_refused(&document));
        document.roll_back(checkpoint);
        assert!(is_refused(&document));
    }
}

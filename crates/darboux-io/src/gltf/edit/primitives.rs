//! Edits of primitives.

use crate::json::{self, Map, Value};

use crate::Error;
use crate::error::ContentError;
use crate::gltf::primitives::append::index_elements;
use crate::gltf::{Document, NewAccessor, Target};

impl Document {
    /// Edits the JSON of a primitive.
    ///
    /// Errors: no such primitive; a result that is not a primitive, after which the primitive is as it was.
    pub fn edit_primitive(
        &mut self,
        mesh: usize,
        primitive: usize,
        edit: impl FnOnce(&mut Map),
    ) -> Result<(), Error> {
        let edited = self.change_primitive(mesh, primitive, |json| {
            if let Some(json) = json.as_object_mut() {
                edit(json);
            }
        });
        edited.map_err(|error| error.in_file(&self.name))
    }

    fn change_primitive(
        &mut self,
        mesh: usize,
        primitive: usize,
        edit: impl FnOnce(&mut Value),
    ) -> Result<(), ContentError> {
        let at = format!("meshes[{mesh}].primitives[{primitive}]");
        let stored = self.json.get_mut("meshes").and_then(|meshes| meshes.get_mut(mesh));
        let stored = stored.and_then(|mesh| mesh.get_mut("primitives")?.get_mut(primitive));
        let stored =
            stored.ok_or_else(|| ContentError::invalid(&at, "does not exist; name one of the document"))?;
        let mut edited = stored.clone();
        edit(&mut edited);
        if edited != *stored {
            self.root.meshes[mesh].primitives[primitive] = json::read(&edited, &at)?;
            *stored = edited;
            self.is_changed = true;
        }
        Ok(())
    }

    /// Removes an extension of a primitive.
    pub(in crate::gltf) fn remove_primitive_extension(
        &mut self,
        mesh: usize,
        primitive: usize,
        name: &str,
    ) -> Result<(), ContentError> {
        self.change_primitive(mesh, primitive, |json| {
            json::remove_extension(json, name);
        })
    }

    /// Replaces the triangles of a primitive by others over the same vertices; strips and fans become lists.
    ///
    /// `corners`: the vertices of the triangles, three per triangle. Indices after the last complete triangle
    /// are dropped. Errors: no such primitive.
    pub fn set_triangles(&mut self, mesh: usize, primitive: usize, corners: Vec<u32>) -> Result<(), Error> {
        let stored = self.root.meshes.get(mesh).and_then(|mesh| mesh.primitives.get(primitive));
        let old = stored.and_then(|primitive| primitive.indices);
        let kind = old.and_then(|old| self.root.accessors.get(old)).map(|old| old.component_type);
        let elements = index_elements(kind, corners);
        let new = NewAccessor::new(elements, Target::Indices).with_metadata_of(old);
        let indices = self.push_in_place_of(old, new);
        self.edit_primitive(mesh, primitive, |json| {
            json.insert("indices", indices.into());
            if json.get("mode").is_some_and(|mode| *mode != 4) {
                json.insert("mode", 4.into());
            }
        })
    }
}

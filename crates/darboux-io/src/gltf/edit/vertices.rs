//! Edits of the vertices of primitives: new values in the place of an attribute's.

use crate::Error;
use crate::gltf::{ComponentType, Document, ElementType, Elements, NewAccessor, PrimitiveName, Target};

impl Document {
    /// Gives the vertices of primitives other positions, which all of them share.
    ///
    /// `positions`: one per vertex. Errors: a primitive that does not exist, or whose attributes have another
    /// length.
    pub fn set_positions(
        &mut self,
        primitives: &[PrimitiveName],
        positions: &[[f32; 3]],
    ) -> Result<(), Error> {
        self.set_attribute(primitives, "POSITION", positions.as_flattened(), ElementType::Vec3)
    }

    /// As [`Document::set_positions`], for unit normals.
    pub fn set_normals(&mut self, primitives: &[PrimitiveName], normals: &[[f32; 3]]) -> Result<(), Error> {
        self.set_attribute(primitives, "NORMAL", normals.as_flattened(), ElementType::Vec3)
    }

    /// As [`Document::set_positions`], for tangents: unit xyz and the sign w.
    /// [`Document::set_corner_tangents`] splits vertices whose corners need different ones.
    pub fn set_tangents(&mut self, primitives: &[PrimitiveName], tangents: &[[f32; 4]]) -> Result<(), Error> {
        self.set_attribute(primitives, "TANGENT", tangents.as_flattened(), ElementType::Vec4)
    }

    /// Puts floats in the place of an attribute's elements, in all of these primitives. The accessor keeps
    /// name, extras and extensions.
    fn set_attribute(
        &mut self,
        primitives: &[PrimitiveName],
        semantic: &str,
        components: &[f32],
        element_type: ElementType,
    ) -> Result<(), Error> {
        let count = components.len() / element_type.components();
        let mut old = None;
        for name in primitives {
            let found = self.primitive(name)?;
            let vertices = found.attributes.get("POSITION").and_then(|&at| self.accessors().get(at));
            let vertex_count = vertices.map_or(0, |accessor| accessor.count);
            if vertex_count != count {
                let sentence = format!("has {vertex_count} vertices, but {count} of {semantic} were given");
                return Err(self.invalid(name.path(), sentence));
            }
            old = old.or(found.attributes.get(semantic).copied());
        }
        let elements = Elements {
            bytes: components.iter().flat_map(|x| x.to_le_bytes()).collect(),
            count,
            component_type: ComponentType::F32,
            element_type,
            normalized: false,
        };
        let new = NewAccessor::new(elements, Target::Vertices).with_metadata_of(old);
        let new = new.with_bounds(semantic == "POSITION");
        let made = self.push_accessor(new);
        primitives.iter().try_for_each(|name| {
            self.edit_primitive(name.mesh, name.primitive, |json| {
                if let Some(attributes) = json.get_mut("attributes").and_then(|value| value.as_object_mut()) {
                    attributes.insert(semantic, made.into());
                }
            })
        })
    }
}

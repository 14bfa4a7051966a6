//! Puts new values in the place of an attribute's.

use std::collections::BTreeMap;

use darboux_io::Error;
use darboux_io::gltf::{ComponentType, Document, ElementType, Elements, NewAccessor, PrimitiveName, Target};

/// Puts vectors of 3 or 4 components in the place of those of an accessor, in these primitives.
pub fn replace<const N: usize>(
    document: &mut Document,
    (semantic, accessor): (&str, usize),
    users: &[&PrimitiveName],
    vectors: &[[f32; N]],
) -> Result<(), Error> {
    let elements = Elements {
        bytes: vectors.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect(),
        count: vectors.len(),
        component_type: ComponentType::F32,
        element_type: if N == 3 { ElementType::Vec3 } else { ElementType::Vec4 },
        normalized: false,
    };
    let new = NewAccessor::new(elements, Target::Vertices).with_metadata_of(Some(accessor));
    let made = document.push_accessor(new);
    users.iter().try_for_each(|name| {
        document.edit_primitive(name.mesh, name.primitive, |json| {
            if let Some(attributes) = json.get_mut("attributes").and_then(|value| value.as_object_mut()) {
                attributes.insert(semantic.to_owned(), made.into());
            }
        })
    })
}

/// The accessors of an attribute of primitives, each with the primitives that use it.
pub fn users_of<'a>(
    document: &Document,
    semantic: &str,
    names: &'a [PrimitiveName],
) -> BTreeMap<usize, Vec<&'a PrimitiveName>> {
    let mut users: BTreeMap<usize, Vec<&PrimitiveName>> = BTreeMap::new();
    for name in names {
        let attributes = &document.meshes()[name.mesh].primitives[name.primitive].attributes;
        if let Some(&accessor) = attributes.get(semantic) {
            users.entry(accessor).or_default().push(name);
        }
    }
    users
}

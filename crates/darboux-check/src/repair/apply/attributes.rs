//! The accessors of attributes.

use std::collections::BTreeMap;

use darboux_io::gltf::{Document, PrimitiveName};

/// The accessors of an attribute of primitives, each with the primitives that use it.
pub fn users_of(
    document: &Document,
    semantic: &str,
    names: &[PrimitiveName],
) -> BTreeMap<usize, Vec<PrimitiveName>> {
    let mut users: BTreeMap<usize, Vec<PrimitiveName>> = BTreeMap::new();
    for name in names {
        let attributes = &document.meshes()[name.mesh].primitives[name.primitive].attributes;
        if let Some(&accessor) = attributes.get(semantic) {
            users.entry(accessor).or_default().push(name.clone());
        }
    }
    users
}

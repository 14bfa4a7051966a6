//! The accessors of attributes.

use std::collections::BTreeMap;

use darboux_io::Error;
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

/// Checks the size of new elements of `N` floats for accessors, each as often as it is named. Errors: the
/// elements take more than the memory limit permits.
pub fn check_rewritten<const N: usize>(
    document: &Document,
    accessors: impl Iterator<Item = usize>,
) -> Result<(), Error> {
    let counts = accessors.filter_map(|index| Some(document.accessors().get(index)?.count));
    let elements = counts.fold(0, usize::saturating_add);
    document.check_new_bytes(elements.saturating_mul(size_of::<[f32; N]>()))
}

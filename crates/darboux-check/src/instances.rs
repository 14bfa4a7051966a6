//! Primitives with the same data, which are checked once.

use std::collections::{BTreeMap, BTreeSet};

use darboux_io::gltf::{Document, PrimitiveCorners, PrimitiveName};

use crate::place::Place;

/// A primitive by the index of its mesh and its own.
pub type Key = (usize, usize);

/// The key of a primitive.
pub fn key(name: &PrimitiveName) -> Key {
    (name.mesh, name.primitive)
}

/// The accessors of semantics.
type Semantics = BTreeMap<String, usize>;

/// What decides the findings about a primitive: its attributes, morph targets, indices, mode and materials.
type SurfaceKey = (Semantics, Vec<Semantics>, Option<usize>, u32, Option<usize>, Vec<usize>);

fn surface_key(document: &Document, name: &PrimitiveName) -> SurfaceKey {
    let primitive = &document.meshes()[name.mesh].primitives[name.primitive];
    let (attributes, targets) = (primitive.attributes.clone(), primitive.targets.clone());
    (attributes, targets, primitive.indices, primitive.mode, primitive.material, primitive.materials())
}

/// The primitives with the same data, for many places at once.
pub struct Groups(BTreeMap<SurfaceKey, Vec<PrimitiveName>>);

impl Groups {
    /// The groups that these places name. The places must exist in the document as it is now.
    pub fn of<'a>(document: &Document, mut places: impl Iterator<Item = &'a Place>) -> Self {
        let mut groups: BTreeMap<SurfaceKey, Vec<PrimitiveName>> = BTreeMap::new();
        if places.any(|place| place.same_as > 0) {
            for (index, mesh) in document.meshes().iter().enumerate() {
                for primitive in 0..mesh.primitives.len() {
                    let name = PrimitiveName::new(index, mesh, primitive);
                    groups.entry(surface_key(document, &name)).or_default().push(name);
                }
            }
        }
        Self(groups)
    }

    /// The primitive that a place names, and all with the same data.
    pub fn at(&self, document: &Document, place: &Place) -> Vec<PrimitiveName> {
        let Some(named) = &place.primitive else { return Vec::new() };
        if place.same_as == 0 {
            return vec![named.clone()];
        }
        self.0.get(&surface_key(document, named)).cloned().unwrap_or_default()
    }
}

/// The primitives that differ in data or materials, each with the number of later ones that do not.
pub fn distinct<'a>(
    document: &Document,
    primitives: Vec<PrimitiveCorners<'a>>,
) -> Vec<(PrimitiveCorners<'a>, usize)> {
    let mut places = BTreeMap::new();
    let mut found: Vec<(PrimitiveCorners<'a>, usize)> = Vec::new();
    for corners in primitives {
        let key = surface_key(document, corners.name());
        match places.get(&key) {
            Some(&place) => {
                let (_, same_as): &mut (_, usize) = &mut found[place];
                *same_as += 1;
            }
            None => {
                places.insert(key, found.len());
                found.push((corners, 0));
            }
        }
    }
    found
}

/// For each primitive the first one with the same data.
pub fn first_with_same_data(document: &Document) -> BTreeMap<Key, Key> {
    let (mut firsts, mut known) = (BTreeMap::new(), BTreeMap::new());
    for (index, mesh) in document.meshes().iter().enumerate() {
        for primitive in 0..mesh.primitives.len() {
            let name = PrimitiveName::new(index, mesh, primitive);
            let first = known.entry(surface_key(document, &name)).or_insert((index, primitive));
            firsts.insert((index, primitive), *first);
        }
    }
    firsts
}

/// The meshes that no node has; none where no node has a mesh, as in a file of meshes alone.
pub fn meshes_without_node(document: &Document) -> BTreeSet<usize> {
    let nodes = document.json()["nodes"].as_array().into_iter().flatten();
    let used: BTreeSet<usize> =
        nodes.filter_map(|node| usize::try_from(node["mesh"].as_u64()?).ok()).collect();
    let all = if used.is_empty() { 0..0 } else { 0..document.meshes().len() };
    all.filter(|mesh| !used.contains(mesh)).collect()
}

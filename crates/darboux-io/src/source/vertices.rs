//! Makes vertices of corners: corners at one position whose other values have the same bits are one vertex.
//!
//! The vertices of a position are a linked list. A position with many different vertices continues in a hash
//! map, so that no file takes more than linear time.

use std::collections::HashMap;

use super::scene::SourceMesh;

/// The vertices of a position that are searched one by one.
const LIST: usize = 16;

/// No vertex.
const NONE: u32 = u32::MAX;

/// Which values of the corners belong to the vertices.
#[derive(Clone, Debug, Default)]
pub struct Used {
    pub normals: bool,
    pub tangents: bool,
    /// The UV sets, by their place in the mesh.
    pub uv_sets: Vec<usize>,
    pub colors: Vec<usize>,
}

impl Used {
    /// Whether all values belong to positions, so that positions are vertices.
    pub fn is_by_position(&self, mesh: &SourceMesh) -> bool {
        let is_by_position = |values: Option<bool>| values.is_none_or(|is_by_position| is_by_position);
        is_by_position(mesh.normals.as_ref().filter(|_| self.normals).map(|values| values.is_by_position()))
            && is_by_position(
                mesh.tangents.as_ref().filter(|_| self.tangents).map(|values| values.is_by_position()),
            )
            && self.uv_sets.iter().all(|&set| {
                let uvs = &mesh.uv_sets[set].uvs;
                uvs.is_by_position() && uvs.values.len() == mesh.positions.len()
            })
            && self.colors.iter().all(|&set| mesh.colors[set].is_by_position())
            && mesh
                .morphs
                .iter()
                .all(|morph| is_by_position(morph.normals.as_ref().map(|values| values.is_by_position())))
    }

    /// The bits of all values of a corner.
    fn key(&self, mesh: &SourceMesh, corner: usize, key: &mut Vec<u32>) {
        key.clear();
        let position = mesh.corners[corner];
        let mut push = |values: Option<&[f32]>| key.extend(values.into_iter().flatten().map(|x| x.to_bits()));
        if let Some(values) = mesh.normals.as_ref().filter(|_| self.normals) {
            push(values.get(corner, position).as_ref().map(|value| &value[..]));
        }
        if let Some(values) = mesh.tangents.as_ref().filter(|_| self.tangents) {
            push(values.get(corner, position).as_ref().map(|value| &value[..]));
        }
        for &set in &self.uv_sets {
            // Corners without UVs have (0, 0).
            let uv = mesh.uv_sets[set].uvs.get(corner, position).unwrap_or_default();
            push(Some(&uv[..]));
        }
        for &set in &self.colors {
            push(mesh.colors[set].get(corner, position).as_ref().map(|value| &value[..]));
        }
        for normals in mesh.morphs.iter().filter_map(|morph| morph.normals.as_ref()) {
            push(normals.get(corner, position).as_ref().map(|value| &value[..]));
        }
    }
}

/// Finds the vertices of the primitives of one mesh, one primitive after the other.
pub struct VertexFinder<'a> {
    mesh: &'a SourceMesh,
    /// The first vertex of each position.
    first: Vec<u32>,
}

/// The vertices of a primitive.
#[derive(Debug, Default)]
pub struct FoundVertices {
    /// The vertex of each corner that was given, in order.
    pub of_corner: Vec<u32>,
    /// A corner of each vertex.
    pub corners: Vec<u32>,
}

impl<'a> VertexFinder<'a> {
    pub fn new(mesh: &'a SourceMesh) -> Self {
        Self { mesh, first: Vec::new() }
    }

    /// The vertices of some corners. `used`: the values that tell vertices apart. All corners have valid
    /// positions.
    pub fn find(&mut self, used: &Used, corners: impl Iterator<Item = u32>) -> FoundVertices {
        let mesh = self.mesh;
        self.first.resize(mesh.positions.len(), NONE);
        let mut found = FoundVertices::default();
        // The next vertex of the same position, and the key of each vertex.
        let (mut next, mut keys): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
        let mut overflow: HashMap<(u32, Box<[u32]>), u32> = HashMap::new();
        let mut key = Vec::new();
        for corner in corners {
            let position = mesh.corners[corner as usize];
            used.key(mesh, corner as usize, &mut key);
            let width = key.len();
            let (mut vertex, mut length) = (self.first[position as usize], 0);
            while vertex != NONE && length < LIST && keys[vertex as usize * width..][..width] != key[..] {
                (vertex, length) = (next[vertex as usize], length + 1);
            }
            let new = found.corners.len() as u32;
            if length == LIST {
                vertex = *overflow.entry((position, key.as_slice().into())).or_insert(new);
            }
            if vertex == NONE || vertex == new {
                vertex = new;
                found.corners.push(corner);
                keys.extend_from_slice(&key);
                if length < LIST {
                    next.push(std::mem::replace(&mut self.first[position as usize], new));
                } else {
                    next.push(NONE);
                }
            }
            found.of_corner.push(vertex);
        }
        found.corners.iter().for_each(|&corner| self.first[mesh.corners[corner as usize] as usize] = NONE);
        found
    }
}

//! Corner tangents to an indexed mesh with the fewest vertices that correctness allows.

use std::collections::HashMap;

use crate::{CornerTangents, Mesh, MeshError};

/// An indexed mesh's vertices after splitting. The old vertices come first, in their old places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexSplit {
    /// One tangent per new vertex: unit xyz and sign w. Vertices that no corner uses get (1, 0, 0, 1).
    pub tangent_of_vertex: Vec<[f32; 4]>,
    /// The new index list, one per corner, in the old corner order.
    pub indices: Vec<u32>,
    /// The old vertex that each new vertex copies; `source_of_vertex[v] == v` for every old vertex. Gather any other attribute,
    /// skin weight or morph target with it: `new[v] = old[source_of_vertex[v]]`.
    pub source_of_vertex: Vec<u32>,
}

/// Splits the vertices whose corners need different tangents.
///
/// One vertex per distinct pair of old vertex and tangent (all four floats compared as bits). Old vertices keep their number;
/// further ones are appended in the order of the corners that ask for them. The index list keeps its length and order.
/// Errors: tangents of another number of corners.
pub fn split_vertices(mesh: &Mesh<'_>, corners: &CornerTangents) -> Result<VertexSplit, MeshError> {
    let mut splitter = Splitter::new(mesh.vertex_count());
    let indices = splitter.add(mesh, corners)?;
    let (tangent_of_vertex, source_of_vertex) = splitter.finish();
    Ok(VertexSplit { tangent_of_vertex, indices, source_of_vertex })
}

/// Splits several meshes over one vertex buffer jointly, so that they go on sharing it.
///
/// [`Splitter::add`] each mesh, then [`Splitter::finish`]. Each `add` costs time in the mesh's corners, not in the buffer's size.
#[derive(Debug)]
pub struct Splitter {
    tangent_of_vertex: Vec<Option<[f32; 4]>>,
    source_of_vertex: Vec<u32>,
    further: HashMap<(u32, [u32; 4]), u32>,
    old_count: usize,
}

impl Splitter {
    /// Starts with `vertex_count` old vertices.
    pub fn new(vertex_count: usize) -> Self {
        Self {
            tangent_of_vertex: vec![None; vertex_count],
            source_of_vertex: (0..vertex_count as u32).collect(),
            further: HashMap::new(),
            old_count: vertex_count,
        }
    }

    /// Gives every corner of `mesh` its vertex: the new index list.
    ///
    /// Errors: tangents of another number of corners, a mesh over another number of vertices.
    pub fn add(&mut self, mesh: &Mesh<'_>, corners: &CornerTangents) -> Result<Vec<u32>, MeshError> {
        expect("corners", mesh.corner_count(), corners.len())?;
        expect("vertices", self.old_count, mesh.vertex_count())?;
        let tangents = corners.per_corner().iter();
        Ok(tangents
            .enumerate()
            .map(|(corner, &tangent)| self.vertex(mesh.vertex_of_corner(corner) as u32, tangent))
            .collect())
    }

    /// The vertex for `old` with `tangent`: the old one if it is free or has this tangent, else an appended one.
    fn vertex(&mut self, old: u32, tangent: [f32; 4]) -> u32 {
        let bits = tangent.map(f32::to_bits);
        match &mut self.tangent_of_vertex[old as usize] {
            Some(held) if held.map(f32::to_bits) == bits => return old,
            Some(_) => {}
            free => {
                *free = Some(tangent);
                return old;
            }
        }
        *self.further.entry((old, bits)).or_insert_with(|| {
            self.tangent_of_vertex.push(Some(tangent));
            self.source_of_vertex.push(old);
            self.source_of_vertex.len() as u32 - 1
        })
    }

    /// The tangent and the source of every new vertex, as in [`VertexSplit`].
    pub fn finish(self) -> (Vec<[f32; 4]>, Vec<u32>) {
        let unused = [1.0, 0.0, 0.0, 1.0];
        let tangents = self.tangent_of_vertex.into_iter().map(|held| held.unwrap_or(unused));
        (tangents.collect(), self.source_of_vertex)
    }
}

/// An error unless as many were found as expected.
pub(crate) fn expect(what: &'static str, expected: usize, found: usize) -> Result<(), MeshError> {
    if expected == found { Ok(()) } else { Err(MeshError::OtherMesh { what, expected, found }) }
}

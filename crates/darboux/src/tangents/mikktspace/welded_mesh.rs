//! Vertex values as the evaluation reads them.

use crate::Mesh;
use crate::math::{V3, equal};
use crate::topology::triangles::Triangles;

/// A mesh read through its welded vertices: every corner has the values of the corner that represents it.
#[derive(Clone, Copy)]
pub(crate) struct WeldedMesh<'a> {
    mesh: &'a Mesh<'a>,
    /// Vertices may have moved apart since they were welded.
    moved: bool,
}

impl<'a> WeldedMesh<'a> {
    /// The mesh that was welded.
    pub fn welded(mesh: &'a Mesh<'a>) -> Self {
        Self { mesh, moved: false }
    }

    /// A mesh whose vertices moved after its twin was welded. Corners whose position left their representative's have their own.
    pub fn moved(mesh: &'a Mesh<'a>) -> Self {
        Self { mesh, moved: true }
    }

    /// The number of corners of the mesh.
    pub fn corner_count(&self) -> usize {
        self.mesh.corner_count()
    }

    /// The position of a corner, its own.
    pub fn position(&self, corner: u32) -> V3 {
        self.mesh.positions().get(self.mesh.vertex_of_corner(corner as usize))
    }

    /// The positions of triangle `t`.
    pub fn positions(&self, triangles: &Triangles, t: usize) -> [V3; 3] {
        let positions = triangles.vertices[t].map(|vertex| self.position(vertex));
        if !self.moved {
            return positions;
        }
        let own = triangles.corners[t].map(|corner| self.position(corner));
        std::array::from_fn(|k| if equal(own[k], positions[k]) { positions[k] } else { own[k] })
    }

    /// The UVs of triangle `t`.
    pub fn uvs(&self, triangles: &Triangles, t: usize) -> [[f32; 2]; 3] {
        triangles.vertices[t].map(|vertex| self.mesh.uvs().get(self.mesh.vertex_of_corner(vertex as usize)))
    }

    /// The normal of a welded vertex, or of a corner.
    pub fn normal(&self, vertex: u32) -> V3 {
        self.mesh.normals().get(self.mesh.vertex_of_corner(vertex as usize))
    }
}

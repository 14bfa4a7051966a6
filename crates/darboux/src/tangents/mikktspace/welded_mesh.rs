//! A mesh read through its welded vertices.

use crate::Mesh;
use crate::math::{V3, equal};
use crate::topology::triangles::Triangles;

/// Positions, normals and UVs of welded vertices: every corner has the values of the corner that represents
/// it.
#[derive(Clone, Copy)]
pub(crate) struct WeldedMesh<'a> {
    mesh: &'a Mesh<'a>,
    /// True where vertices may have moved apart since they were welded.
    has_moved: bool,
}

impl<'a> WeldedMesh<'a> {
    /// The mesh that was welded.
    pub fn new(mesh: &'a Mesh<'a>) -> Self {
        Self { mesh, has_moved: false }
    }

    /// The mesh after its vertices moved. Corners whose position differs from their representative's keep
    /// their own position.
    pub fn moved(mesh: &'a Mesh<'a>) -> Self {
        Self { mesh, has_moved: true }
    }

    /// The number of corners of the mesh.
    pub fn corner_count(&self) -> usize {
        self.mesh.corner_count()
    }

    /// The position of a corner.
    pub fn position(&self, corner: u32) -> V3 {
        self.mesh.positions().get(self.mesh.vertex_of_corner(corner as usize))
    }

    /// The positions of triangle `t`.
    pub fn positions(&self, triangles: &Triangles, t: usize) -> [V3; 3] {
        let positions = triangles.vertices[t].map(|vertex| self.position(vertex));
        if !self.has_moved {
            return positions;
        }
        let own = triangles.corners[t].map(|corner| self.position(corner));
        std::array::from_fn(|k| if equal(own[k], positions[k]) { positions[k] } else { own[k] })
    }

    /// The UVs of triangle `t`.
    pub fn uvs(&self, triangles: &Triangles, t: usize) -> [[f32; 2]; 3] {
        triangles.vertices[t].map(|vertex| self.mesh.uvs().get(self.mesh.vertex_of_corner(vertex as usize)))
    }

    /// The normal of a corner, or of a welded vertex by the corner that represents it.
    pub fn normal(&self, corner: u32) -> V3 {
        self.mesh.normals().get(self.mesh.vertex_of_corner(corner as usize))
    }
}

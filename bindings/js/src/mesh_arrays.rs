//! The arrays of a mesh, as JavaScript writes them, and the borrowed `Mesh` that the core takes.

use darboux::{Faces, Indices, Mesh, Strided};

/// The part of a mesh that a `Plan` evaluates again: positions and normals, three floats per vertex each.
#[derive(Default)]
pub struct Vertices {
    pub positions: Vec<f32>,
    pub normals: Vec<f32>,
}

/// The part of a mesh that a `Plan` keeps: UVs and topology.
#[derive(Default)]
pub struct Surface {
    /// Two per vertex.
    pub uvs: Vec<f32>,
    /// The vertex of each corner. Ignored unless `is_indexed`.
    pub indices: Vec<u32>,
    /// Corners per face. Empty: all faces are triangles.
    pub face_sizes: Vec<u32>,
    pub is_indexed: bool,
}

impl Vertices {
    /// The mesh of these vertices and a surface. `None` where an index is out of range.
    pub fn mesh<'a>(&'a self, surface: &'a Surface) -> Option<Mesh<'a>> {
        let (positions, normals, uvs) = (self.positions(), rows(&self.normals), rows(&surface.uvs));
        Mesh::with_faces(positions, normals, uvs, surface.indices(), surface.faces()).ok()
    }

    pub fn positions(&self) -> Strided<'_, 3> {
        Strided::from(rows(&self.positions))
    }
}

impl Surface {
    pub fn indices(&self) -> Indices<'_> {
        if self.is_indexed { Indices::U32(&self.indices) } else { Indices::Unindexed }
    }

    pub fn faces(&self) -> Faces<'_> {
        if self.face_sizes.is_empty() { Faces::Triangles } else { Faces::Mixed(&self.face_sizes) }
    }
}

/// A flat array as rows of `N` floats.
pub fn rows<const N: usize>(floats: &[f32]) -> &[[f32; N]] {
    floats.as_chunks().0
}

/// As [`rows`], for writing.
#[cfg(feature = "full")]
pub fn rows_mut<const N: usize>(floats: &mut [f32]) -> &mut [[f32; N]] {
    floats.as_chunks_mut().0
}

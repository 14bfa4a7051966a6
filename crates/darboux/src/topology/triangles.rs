//! Triangle lists as parallel arrays: what welding, adjacency, grouping and evaluation read and write.

/// Sentinel of index arrays: no triangle, no corner, no sum.
pub const NONE: u32 = u32::MAX;

/// Triangles as parallel arrays, one entry per triangle.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    /// The three corners of the mesh.
    pub corners: Vec<[u32; 3]>,
    /// The three welded vertices. A welded vertex is named by the corner that represents it.
    pub vertices: Vec<[u32; 3]>,
    /// The face that the triangle is, or is half of. Ascending.
    pub face: Vec<u32>,
}

impl Triangles {
    pub(crate) fn len(&self) -> usize {
        self.face.len()
    }

    /// True when triangles `t` and `t + 1` are the halves of one quad.
    pub fn is_pair(&self, t: usize) -> bool {
        t + 1 < self.len() && self.face[t] == self.face[t + 1]
    }

    pub(crate) fn push(&mut self, corners: [u32; 3], vertices: [u32; 3], face: u32) {
        self.corners.push(corners);
        self.vertices.push(vertices);
        self.face.push(face);
    }
}

/// The welded triangles of a mesh. Both lists keep the order of the faces.
#[derive(Clone, Debug, Default)]
pub struct Triangulation {
    /// Triangles with three distinct positions.
    pub good: Triangles,
    /// Triangles with two equal positions.
    pub degenerate: Triangles,
    /// The number of faces of other than 3 or 4 corners.
    pub unsupported_faces: usize,
    /// The corners of these faces.
    pub unsupported_corners: Vec<u32>,
}

//! Triangle lists as parallel arrays: the common data of welding, adjacency, grouping and evaluation.

/// Sentinel in index arrays: no triangle, no corner, no sum.
pub const NONE: u32 = u32::MAX;

/// Triangles as parallel arrays.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    /// The corner of the mesh at each of the three corners.
    pub corners: Vec<[u32; 3]>,
    /// The welded vertex there, named by the corner that represents it.
    pub vertices: Vec<[u32; 3]>,
    /// The face that the triangle is, or is half of.
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

    pub(crate) fn push(&mut self, corners: [u32; 3], face: usize) {
        self.corners.push(corners);
        self.face.push(face as u32);
    }

    pub(crate) fn push_welded(&mut self, corners: [u32; 3], vertices: [u32; 3], face: u32) {
        self.corners.push(corners);
        self.vertices.push(vertices);
        self.face.push(face);
    }
}

/// The triangles of a mesh, welded.
#[derive(Clone, Debug, Default)]
pub struct Triangulation {
    /// Triangles with three distinct positions.
    pub good: Triangles,
    /// Triangles with two equal positions.
    pub degenerate: Triangles,
    /// The number of faces of other than 3 or 4 corners.
    pub unsupported_faces: usize,
    /// These corners.
    pub unsupported_corners: Vec<u32>,
}

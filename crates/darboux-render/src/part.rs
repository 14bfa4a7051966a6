//! The triangles of one primitive in one pose.

use std::sync::Arc;

use crate::algebra::Matrix;
use crate::vertex::SurfaceVertex;

/// A primitive in one pose, with all places where the scene has it.
#[derive(Clone)]
pub struct Part {
    /// The index of the mesh.
    pub mesh: usize,
    /// Identifies the part: the indices of its mesh, its primitive and its pose.
    pub key: [usize; 3],
    /// The index of its material.
    pub material: Option<usize>,
    /// Three per triangle, without triangles whose positions are not finite.
    pub corners: Vec<SurfaceVertex>,
    pub has_tangents: bool,
    /// The number of triangles whose positions are not finite.
    pub skipped_triangles: usize,
    /// The UVs that the tangents follow, one per corner; empty if there are none.
    pub tangent_uvs: Vec<[f32; 2]>,
    /// The matrices from the mesh to the scene, one per place.
    pub matrices: Arc<[Matrix]>,
}

impl Part {
    /// A part with nothing but corners and matrices.
    #[cfg(test)]
    pub fn of(corners: Vec<SurfaceVertex>, matrices: &[Matrix]) -> Self {
        Self {
            mesh: 0,
            key: [0; 3],
            material: None,
            corners,
            has_tangents: true,
            skipped_triangles: 0,
            tangent_uvs: Vec::new(),
            matrices: matrices.into(),
        }
    }

    /// Whether both parts have tangents, for equally many corners.
    pub fn is_comparable(&self, other: &Part) -> bool {
        self.has_tangents && other.has_tangents && self.corners.len() == other.corners.len()
    }

    /// The number of triangles at all places.
    pub fn triangle_count(&self) -> u64 {
        (self.corners.len() / 3) as u64 * self.matrices.len() as u64
    }
}

/// The position of a UV in the layout, whose v axis points down.
pub fn layout_position([u, v]: [f32; 2]) -> [f32; 3] {
    [u, -v, 0.0]
}

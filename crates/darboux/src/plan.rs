//! Topology once, evaluate often.

use crate::{CornerTangents, Mesh, MeshError, TangentOptions, Tangents};

/// The weld, groups and split of one mesh, kept to evaluate tangents again after its vertices moved (morph targets, skinning).
pub struct Plan {
    base: Tangents,
}

impl Plan {
    /// Computes the base's tangents and keeps its topology.
    pub fn new(_mesh: &Mesh<'_>, _options: &TangentOptions) -> Self {
        todo!("the core lands within the hour")
    }

    /// The base's own tangents, as [`crate::generate_tangents`] gives them.
    pub fn base(&self) -> &Tangents {
        &self.base
    }

    /// Tangents of the moved mesh in the base's groups; signs stay the base's.
    ///
    /// `mesh`: same faces, indices and UVs as the base, other positions and normals. Errors: another number of corners or vertices.
    pub fn evaluate(&self, _mesh: &Mesh<'_>) -> Result<CornerTangents, MeshError> {
        todo!("the core lands within the hour")
    }

    /// How many corners a fresh run on the moved mesh would give another tangent (other bits) than [`Plan::evaluate`].
    pub fn count_regrouped(&self, _mesh: &Mesh<'_>) -> Result<usize, MeshError> {
        todo!("the core lands within the hour")
    }
}

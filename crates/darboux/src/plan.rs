//! Topology once, evaluate often.

use crate::split::expect;
use crate::tangents::mikktspace::Topology;
use crate::{CornerTangents, Frame, Mesh, MeshError, TangentOptions, Tangents, generate_tangents};

/// The weld, groups and subgroups of one mesh, kept to evaluate tangents again after its vertices moved (morph targets, skinning).
#[derive(Debug)]
pub struct Plan {
    topology: Topology,
    options: TangentOptions,
    vertex_count: usize,
    base: Tangents,
}

impl Plan {
    /// Computes the base's tangents and keeps its topology.
    pub fn new(mesh: &Mesh<'_>, options: &TangentOptions) -> Self {
        let topology = Topology::new(mesh, options);
        let (frames, report) = topology.frames(mesh);
        let base = Tangents { corners: corner_tangents(&frames), report };
        Self { topology, options: *options, vertex_count: mesh.vertex_count(), base }
    }

    /// The base's own tangents, as [`crate::generate_tangents`] gives them.
    pub fn base(&self) -> &Tangents {
        &self.base
    }

    /// Tangents of the moved mesh in the base's groups and subgroups; signs stay the base's.
    ///
    /// `mesh`: same faces, indices and UVs as the base, other positions and normals. Vertices that were welded and moved apart keep
    /// their common frame, but each triangle counts with the positions of its own vertices. Errors: another number of corners
    /// or vertices.
    pub fn evaluate(&self, mesh: &Mesh<'_>) -> Result<CornerTangents, MeshError> {
        expect("corners", self.base.corners.len(), mesh.corner_count())?;
        expect("vertices", self.vertex_count, mesh.vertex_count())?;
        let mut moved = corner_tangents(&self.topology.frames_of_moved(mesh).0);
        moved.take_signs(&self.base.corners);
        Ok(moved)
    }

    /// How many corners a fresh run on the moved mesh would give another tangent (other bits) than [`Plan::evaluate`].
    pub fn count_regrouped(&self, mesh: &Mesh<'_>) -> Result<usize, MeshError> {
        let planned = self.evaluate(mesh)?;
        let fresh = generate_tangents(mesh, &self.options).corners;
        let pairs = planned.per_corner().iter().zip(fresh.per_corner());
        Ok(pairs.filter(|(planned, fresh)| planned.map(f32::to_bits) != fresh.map(f32::to_bits)).count())
    }
}

fn corner_tangents(frames: &[Frame]) -> CornerTangents {
    CornerTangents(frames.iter().map(Frame::tangent_and_sign).collect())
}

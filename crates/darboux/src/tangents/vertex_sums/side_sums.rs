//! The sums of all vertices, apart for the two UV orientations.

use crate::math::V3;

use crate::tangents::mesh_slices::MeshSlices;
use crate::tangents::method_buffers::{MethodBuffers, SumBuffers};
use crate::tangents::report::are_finite;
use crate::tangents::uv_derivatives::{Orientation, is_degenerate};
use crate::tangents::vertex_sums::weighting::SumRows;

/// The sums of all vertices and what was met on the way.
pub(crate) struct SideSums<const N: usize> {
    /// Per orientation and vertex; none of an orientation that no triangle has, but that the first is always there.
    pub of_side: [Vec<SumRows<N>>; 2],
    pub orientation_of_face: Vec<Orientation>,
    pub flaws: SkippedTriangles,
}

/// Triangles that add nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SkippedTriangles {
    pub degenerate: usize,
    pub uv_degenerate: usize,
    /// Others, with a value that is not finite.
    non_finite: usize,
}

impl SkippedTriangles {
    pub fn are_none(&self) -> bool {
        self.degenerate + self.uv_degenerate + self.non_finite == 0
    }

    #[cold]
    pub fn count(&mut self, positions: [&V3; 3], uvs: [&[f32; 2]; 3]) {
        if is_degenerate(positions.map(|position| *position)) {
            self.degenerate += 1;
        } else if !are_finite(positions.map(|position| *position), uvs.map(|uv| *uv)) {
            self.non_finite += 1;
        } else {
            self.uv_degenerate += 1;
        }
    }

    pub fn add(&mut self, other: Self) {
        self.degenerate += other.degenerate;
        self.uv_degenerate += other.uv_degenerate;
        self.non_finite += other.non_finite;
    }
}

impl<const N: usize> SideSums<N> {
    /// Room for sums, in the memory of earlier ones. What the first side holds is anything.
    pub fn new(flat: &MeshSlices<'_>, memory: &mut MethodBuffers) -> Self
    where
        MethodBuffers: SumBuffers<N>,
    {
        let mut of_side = std::mem::take(memory.of_side());
        let mut orientation_of_face = std::mem::take(&mut memory.orientation_of_face);
        of_side[0].resize(flat.positions.len(), [[0.0; 4]; N]);
        of_side[1].clear();
        orientation_of_face.resize(flat.triangles().len(), Orientation::None);
        Self { of_side, orientation_of_face, flaws: SkippedTriangles::default() }
    }

    /// Leaves the memory for others.
    pub fn keep(self, memory: &mut MethodBuffers)
    where
        MethodBuffers: SumBuffers<N>,
    {
        *memory.of_side() = self.of_side;
        memory.orientation_of_face = self.orientation_of_face;
    }
}

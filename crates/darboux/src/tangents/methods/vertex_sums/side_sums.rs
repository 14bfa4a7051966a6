//! The sums of all vertices, apart for the two UV orientations, and the counts of skipped triangles.

use crate::math::V3;

use crate::tangents::methods::buffers::{MethodBuffers, SumBuffers};
use crate::tangents::methods::mesh_slices::MeshSlices;
use crate::tangents::methods::uv_derivatives::{Orientation, is_degenerate};
use crate::tangents::methods::vertex_sums::weighting::SumRows;
use crate::tangents::report::are_finite;

/// The result of accumulation.
pub(crate) struct SideSums<const N: usize> {
    /// One sum per vertex for each orientation: preserved and mirrored. The mirrored list is empty where no
    /// triangle is mirrored.
    pub sums_of_side: [Vec<SumRows<N>>; 2],
    pub orientation_of_face: Vec<Orientation>,
    pub skipped: SkippedTriangles,
}

/// The numbers of triangles that are skipped, by reason.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SkippedTriangles {
    pub degenerate: usize,
    pub uv_degenerate: usize,
    /// Triangles with a position or a UV that is not finite, and that are not degenerate.
    non_finite: usize,
}

impl SkippedTriangles {
    /// True when no triangle is skipped.
    pub fn is_empty(&self) -> bool {
        self.degenerate + self.uv_degenerate + self.non_finite == 0
    }

    /// Counts a skipped triangle.
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
    /// Takes the buffers and resizes them. The content of the preserved list is unspecified.
    pub fn new(slices: &MeshSlices<'_>, buffers: &mut MethodBuffers) -> Self
    where
        MethodBuffers: SumBuffers<N>,
    {
        let mut sums_of_side = std::mem::take(buffers.sums_of_side());
        let mut orientation_of_face = std::mem::take(&mut buffers.orientation_of_face);
        sums_of_side[0].resize(slices.positions.len(), [[0.0; 4]; N]);
        sums_of_side[1].clear();
        orientation_of_face.resize(slices.triangles().len(), Orientation::None);
        Self { sums_of_side, orientation_of_face, skipped: SkippedTriangles::default() }
    }

    /// Returns the buffers for the next run.
    pub fn return_to(self, buffers: &mut MethodBuffers)
    where
        MethodBuffers: SumBuffers<N>,
    {
        *buffers.sums_of_side() = self.sums_of_side;
        buffers.orientation_of_face = self.orientation_of_face;
    }
}

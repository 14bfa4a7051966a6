//! The buffers of the methods other than MikkTSpace, reused from run to run.

use crate::tangents::methods::angle_area::group_sums::GroupBuffers;
use crate::tangents::methods::uv_derivatives::Orientation;
use crate::tangents::methods::vertex_sums::weighting::SumRows;

/// All buffers. Each method resizes those that it uses.
#[derive(Debug, Default)]
pub(crate) struct MethodBuffers {
    /// Sums of two rows and of three rows, per orientation.
    of_two_rows: [Vec<SumRows<2>>; 2],
    of_three_rows: [Vec<SumRows<3>>; 2],
    pub orientation_of_face: Vec<Orientation>,
    /// The tangents of all vertices, per orientation.
    pub tangents_of_side: [Vec<[f32; 4]>; 2],
    /// The buffers of the angle-area method.
    pub of_groups: GroupBuffers,
}

/// Selects the buffer of sums of `N` rows.
pub(crate) trait SumBuffers<const N: usize> {
    fn sums_of_side(&mut self) -> &mut [Vec<SumRows<N>>; 2];
}

impl SumBuffers<2> for MethodBuffers {
    fn sums_of_side(&mut self) -> &mut [Vec<SumRows<2>>; 2] {
        &mut self.of_two_rows
    }
}

impl SumBuffers<3> for MethodBuffers {
    fn sums_of_side(&mut self) -> &mut [Vec<SumRows<3>>; 2] {
        &mut self.of_three_rows
    }
}

//! The methods other than MikkTSpace, what they share, and the choice of a method: one branch per method.

pub(crate) mod angle_area;
pub(crate) mod buffers;
mod face;
mod from_normal;
mod mesh_slices;
mod report_counts;
mod uv_derivatives;
mod vertex_sums;

use crate::Mesh;

use crate::exec::limits::RunLimits;
use crate::tangents::MikkTSpaceOptions;
use crate::tangents::methods::angle_area::group_sums::GroupWeight;
use crate::tangents::methods::buffers::{MethodBuffers, SumBuffers};
use crate::tangents::methods::mesh_slices::MeshSlices;
use crate::tangents::methods::vertex_sums::accumulate::accumulate;
use crate::tangents::methods::vertex_sums::area::Area;
use crate::tangents::methods::vertex_sums::average::Average;
use crate::tangents::methods::vertex_sums::finish::finish;
use crate::tangents::methods::vertex_sums::lengyel::{Lengyel, LengyelPerVertex};
use crate::tangents::methods::vertex_sums::side_sums::SideSums;
use crate::tangents::methods::vertex_sums::weighting::Weighting;
use crate::tangents::options::Method;
use crate::tangents::output::Output;
use crate::tangents::report::Report;

/// Runs a method. `corners`: receives one output per corner. `mikktspace`: runs MikkTSpace, in the way of the
/// caller.
///
/// The choice is made in the caller's code, so that a program whose method is constant links no other.
#[inline(always)]
pub(crate) fn run<O: Output>(
    mesh: &Mesh<'_>,
    method: Method,
    limits: RunLimits<'_>,
    buffers: &mut MethodBuffers,
    corners: &mut [O],
    mikktspace: impl FnOnce(&MikkTSpaceOptions, &mut [O]) -> Report,
) -> Report {
    match method {
        Method::MikkTSpace(options) => mikktspace(&options, corners),
        Method::AngleArea => {
            angle_area::run(mesh, GroupWeight::Area, limits, &mut buffers.of_groups, corners)
        }
        Method::AngleEdge => {
            angle_area::run(mesh, GroupWeight::Edges, limits, &mut buffers.of_groups, corners)
        }
        Method::Lengyel => summed::<2, Lengyel, O>(mesh, limits, accumulate::<2, Lengyel>, buffers, corners),
        Method::LengyelPerVertex => summed::<2, LengyelPerVertex, O>(
            mesh,
            limits,
            accumulate::<2, LengyelPerVertex>,
            buffers,
            corners,
        ),
        Method::Average => summed::<3, Average, O>(mesh, limits, accumulate::<3, Average>, buffers, corners),
        Method::Area => summed::<3, Area, O>(mesh, limits, accumulate::<3, Area>, buffers, corners),
        Method::Face => face::run(mesh, limits, corners),
        Method::FromNormal => from_normal::run(mesh, limits, corners),
    }
}

/// Runs a method of vertex sums. `add_up`: [`accumulate`] for the method.
fn summed<const N: usize, W: Weighting<N>, O: Output>(
    mesh: &Mesh<'_>,
    limits: RunLimits<'_>,
    add_up: fn(&MeshSlices<'_>, RunLimits<'_>, &mut SideSums<N>),
    buffers: &mut MethodBuffers,
    corners: &mut [O],
) -> Report
where
    MethodBuffers: SumBuffers<N>,
{
    let slices = MeshSlices::new(mesh);
    let (mut sums, mut frames) =
        (SideSums::new(&slices, buffers), O::take_buffers(&mut buffers.tangents_of_side));
    add_up(&slices, limits, &mut sums);
    let report = if limits.is_cancelled() {
        Report::default()
    } else {
        finish::<N, W, O>(mesh, &slices, &mut sums, limits, &mut frames, corners)
    };
    sums.return_to(buffers);
    O::return_buffers(frames, &mut buffers.tangents_of_side);
    report
}

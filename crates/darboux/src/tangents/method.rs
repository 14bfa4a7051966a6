//! Runs the chosen method: one branch per method.

use crate::Mesh;

use crate::exec::limits::RunLimits;
use crate::exec::threads;
use crate::tangents::MikkTSpaceOptions;
use crate::tangents::angle_area;
use crate::tangents::angle_area::group_sums::GroupWeight;
use crate::tangents::face;
use crate::tangents::from_normal;
use crate::tangents::mesh_slices::MeshSlices;
use crate::tangents::method_buffers::{MethodBuffers, SumBuffers};
use crate::tangents::mikktspace;
use crate::tangents::options::Method;
use crate::tangents::output::{Output, fill};
use crate::tangents::report::Report;
use crate::tangents::vertex_sums::accumulate::accumulate;
use crate::tangents::vertex_sums::area::Area;
use crate::tangents::vertex_sums::average::Average;
use crate::tangents::vertex_sums::finish::finish;
use crate::tangents::vertex_sums::lengyel::{Lengyel, LengyelPerVertex};
use crate::tangents::vertex_sums::side_sums::SideSums;
use crate::tangents::vertex_sums::weighting::Weighting;

/// Runs a method. `corners`: receives one output per corner.
pub(crate) fn run<O: Output>(
    mesh: &Mesh<'_>,
    method: Method,
    limits: RunLimits<'_>,
    memory: &mut MethodBuffers,
    corners: &mut [O],
) -> Report {
    match method {
        Method::MikkTSpace(options) => mikktspace(mesh, &options, limits, corners),
        Method::AngleArea => angle_area::run(mesh, GroupWeight::Area, limits, &mut memory.of_groups, corners),
        Method::AngleEdge => {
            angle_area::run(mesh, GroupWeight::Edges, limits, &mut memory.of_groups, corners)
        }
        Method::Lengyel => summed::<2, Lengyel, O>(mesh, limits, accumulate::<2, Lengyel>, memory, corners),
        Method::LengyelPerVertex => {
            summed::<2, LengyelPerVertex, O>(mesh, limits, accumulate::<2, LengyelPerVertex>, memory, corners)
        }
        Method::Average => summed::<3, Average, O>(mesh, limits, accumulate::<3, Average>, memory, corners),
        Method::Area => summed::<3, Area, O>(mesh, limits, accumulate::<3, Area>, memory, corners),
        Method::Face => face::run(mesh, limits, corners),
        Method::FromNormal => from_normal::run(mesh, limits, corners),
    }
}

/// MikkTSpace by its stages.
pub(crate) fn mikktspace<O: Output>(
    mesh: &Mesh<'_>,
    options: &MikkTSpaceOptions,
    limits: RunLimits<'_>,
    corners: &mut [O],
) -> Report {
    let Some(topology) = mikktspace::GroupedMesh::new(mesh, options, limits) else {
        return Report::default();
    };
    let (frames, report) = topology.frames(mesh, limits);
    fill(corners, frames.iter().map(O::from_frame));
    report
}

/// Runs a method of vertex sums. `add_up`: [`accumulate`] for the method.
fn summed<const N: usize, W: Weighting<N>, O: Output>(
    mesh: &Mesh<'_>,
    limits: RunLimits<'_>,
    add_up: fn(&MeshSlices<'_>, RunLimits<'_>, &mut SideSums<N>),
    memory: &mut MethodBuffers,
    corners: &mut [O],
) -> Report
where
    MethodBuffers: SumBuffers<N>,
{
    let slices = MeshSlices::new(mesh);
    let (mut sums, mut frames) =
        (SideSums::new(&slices, memory), O::take_buffers(&mut memory.tangents_of_side));
    let report = threads::on_pool(limits.thread_count(slices.triangles().len()), || {
        add_up(&slices, limits, &mut sums);
        if limits.is_cancelled() {
            return Report::default();
        }
        finish::<N, W, O>(mesh, &slices, &mut sums, limits, &mut frames, corners)
    });
    sums.return_to(memory);
    O::return_buffers(frames, &mut memory.tangents_of_side);
    report
}

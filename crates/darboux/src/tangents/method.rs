//! The choice of a method, and where it leads.

use crate::Mesh;
use crate::Mode;
use crate::cancel::Stop;

use crate::exec::simd::Width;
use crate::exec::threads;
use crate::tangents::TangentOptions;
use crate::tangents::angle_area;
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

/// Runs the method of `options`. `corners`: receives one output per corner.
pub(crate) fn run<O: Output>(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    stop: &Stop,
    width: Width,
    memory: &mut MethodBuffers,
    corners: &mut [O],
) -> Report {
    let mode = options.mode;
    match options.method {
        Method::MikkTSpace => mikktspace(mesh, options, stop, corners),
        Method::AngleArea => angle_area::run(mesh, mode, &mut memory.of_groups, corners),
        Method::Lengyel => {
            summed::<2, Lengyel, O>(mesh, (mode, width), accumulate::<2, Lengyel>, memory, corners)
        }
        Method::LengyelPerVertex => summed::<2, LengyelPerVertex, O>(
            mesh,
            (mode, width),
            accumulate::<2, LengyelPerVertex>,
            memory,
            corners,
        ),
        Method::Average => {
            summed::<3, Average, O>(mesh, (mode, width), accumulate::<3, Average>, memory, corners)
        }
        Method::Area => summed::<3, Area, O>(mesh, (mode, width), accumulate::<3, Area>, memory, corners),
        Method::Face => face::run(mesh, mode, corners),
        Method::FromNormal => from_normal::run(mesh, mode, corners),
    }
}

/// MikkTSpace by its stages.
pub(crate) fn mikktspace<O: Output>(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    stop: &Stop,
    corners: &mut [O],
) -> Report {
    let Some(topology) = mikktspace::GroupedMesh::new(mesh, options, stop) else { return Report::default() };
    let (frames, report) = topology.frames(mesh, stop);
    fill(corners, frames.iter().map(O::from_frame));
    report
}

/// SideSums as `add_up` does, and makes corners of the sums.
fn summed<const N: usize, W: Weighting<N>, O: Output>(
    mesh: &Mesh<'_>,
    (mode, width): (Mode, Width),
    add_up: fn(&MeshSlices<'_>, Width, &mut SideSums<N>),
    memory: &mut MethodBuffers,
    corners: &mut [O],
) -> Report
where
    MethodBuffers: SumBuffers<N>,
{
    let flat = MeshSlices::new(mesh);
    let (mut sums, mut frames) = (SideSums::new(&flat, memory), O::kept(&mut memory.tangents_of_side));
    let report = threads::on_pool(threads::count(flat.triangles().len()), || {
        add_up(&flat, width, &mut sums);
        finish::<N, W, O>(mesh, &flat, &mut sums, (mode, width), &mut frames, corners)
    });
    sums.keep(memory);
    O::keep(frames, &mut memory.tangents_of_side);
    report
}

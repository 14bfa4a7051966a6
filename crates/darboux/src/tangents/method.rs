//! The choice of a method, and where it leads.

use crate::cancel::Stop;
use crate::{Mesh, Mode};

use super::accumulate::{Keeps, Memory, Sums, accumulate};
use super::area::Area;
use super::average::Average;
use super::flat::Flat;
use super::lengyel::{Lengyel, LengyelPerVertex};
use super::sides::{Output, fill, finish};
use super::sums::Weighting;
use super::width::Width;
use super::{Report, TangentOptions, angle_area, face, from_normal, mikktspace, threads};

/// How tangents are computed. Normal maps need the method that they were baked with, nearly always the default.
///
/// All but [`Method::MikkTSpace`] leave out triangles whose values are not finite, give every face one sign, and take
/// [`Mode::Corrected`](crate::Mode) for [`Mode::Repaired`](crate::Mode). Derivations are in docs/algorithms/methods.md.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Method {
    /// The standard of bakers and renderers: sums of unit tangents weighted by corner angles, over welded vertices.
    #[default]
    MikkTSpace,
    /// MikkTSpace's groups with weights of corner angle times area: nearest to the UVs where the mesh was cut unevenly, so the choice
    /// where no baked map asks for another.
    AngleArea,
    /// Per vertex the sum of dP/du, as long as they are: large where UVs are dense. One sum per UV orientation (Lengyel 2001).
    Lengyel,
    /// As `Lengyel` with one sum per vertex, as three.js and many tutorials have it: mirrored seams break, and are counted in
    /// [`Report::merged_vertices`]. One tangent per vertex, so nothing splits; signs can differ within a face.
    LengyelPerVertex,
    /// Per vertex and UV orientation the mean of the unit tangents, every triangle counting the same.
    Average,
    /// Per vertex and UV orientation the mean of the unit tangents, weighted by area. Where a normal is absent (zero) the tangent is
    /// perpendicular to the mean of the triangles' normals instead.
    Area,
    /// Per face dP/du itself, in the plane of the face: exact on each, not smooth.
    Face,
    /// A perpendicular of the normal, without any UVs (Duff et al. 2017).
    FromNormal,
}

/// Runs the method of `options`. `corners`: receives one output per corner.
pub(super) fn run<O: Output>(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    stop: &Stop,
    width: Width,
    memory: &mut Memory,
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
pub(super) fn mikktspace<O: Output>(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    stop: &Stop,
    corners: &mut [O],
) -> Report {
    let Some(topology) = mikktspace::Topology::new(mesh, options, stop) else { return Report::default() };
    let (frames, report) = topology.frames(mesh, stop);
    fill(corners, frames.iter().map(O::from_frame));
    report
}

/// Sums as `add_up` does, and makes corners of the sums.
fn summed<const N: usize, W: Weighting<N>, O: Output>(
    mesh: &Mesh<'_>,
    (mode, width): (Mode, Width),
    add_up: fn(&Flat<'_>, Width, &mut Sums<N>),
    memory: &mut Memory,
    corners: &mut [O],
) -> Report
where
    Memory: Keeps<N>,
{
    let flat = Flat::new(mesh);
    let (mut sums, mut frames) = (Sums::new(&flat, memory), O::kept(memory));
    let report = threads::on_pool(threads::count(flat.triangles().len()), || {
        add_up(&flat, width, &mut sums);
        finish::<N, W, O>(mesh, &flat, &mut sums, (mode, width), &mut frames, corners)
    });
    sums.keep(memory);
    O::keep(frames, memory);
    report
}

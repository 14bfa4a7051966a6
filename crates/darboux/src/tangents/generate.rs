//! The tangents of a mesh by any method: the choice of the method, without checks of arguments and of cancellation.

use crate::CornerTangents;
use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::tangents::memory::TangentMemory;
use crate::tangents::method;
use crate::tangents::options::{Method, MikkTSpaceOptions, TangentOptions};
use crate::tangents::report::Report;
use crate::tangents::submesh;

/// The tangents of corners and the report of the run.
#[derive(Clone, Debug, Default)]
pub struct Tangents {
    /// One tangent per corner.
    pub corners: CornerTangents,
    /// Counts of unusual geometry in the mesh.
    pub report: Report,
}

/// Computes the tangent of every corner. The tangents are unspecified after cancellation.
#[inline(always)]
pub(crate) fn generate(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    limits: RunLimits<'_>,
    memory: &mut TangentMemory,
) -> Tangents {
    let mut tangents = Tangents::default();
    tangents.corners.0.resize(mesh.corner_count(), [0.0; 4]);
    tangents.report = run(mesh, options, limits, memory, &mut tangents.corners.0);
    tangents
}

/// Chooses the method in the caller's code, so that a program whose method is constant links no other.
#[inline(always)]
pub(crate) fn run(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    limits: RunLimits<'_>,
    memory: &mut TangentMemory,
    out: &mut [[f32; 4]],
) -> Report {
    match options.method {
        Method::MikkTSpace(options) => mikktspace_of_corners(mesh, &options, limits, memory, out),
        method => method::run(mesh, method, limits, &mut memory.sums, out),
    }
}

fn mikktspace_of_corners(
    mesh: &Mesh<'_>,
    options: &MikkTSpaceOptions,
    limits: RunLimits<'_>,
    memory: &mut TangentMemory,
    out: &mut [[f32; 4]],
) -> Report {
    if memory.fast.run(mesh, options, limits, out) {
        if limits.is_cancelled() {
            Report::default()
        } else {
            submesh::decide(mesh, options, &memory.fast, limits, out)
        }
    } else {
        method::mikktspace(mesh, options, limits, out)
    }
}

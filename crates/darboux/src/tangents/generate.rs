//! The tangents of a mesh by any method: the choice of the method, without checks of arguments and of
//! cancellation.

use crate::CornerTangents;
use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::tangents::fast::FastPath;
use crate::tangents::memory::TangentMemory;
use crate::tangents::methods;
use crate::tangents::mikktspace;
use crate::tangents::options::{MikkTSpaceOptions, TangentOptions};
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

/// Runs the method that the options name.
#[inline(always)]
pub(crate) fn run(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    limits: RunLimits<'_>,
    memory: &mut TangentMemory,
    out: &mut [[f32; 4]],
) -> Report {
    let TangentMemory { fast, sums, .. } = memory;
    methods::run(mesh, options.method, limits, sums, out, |options, out| {
        run_mikktspace(mesh, options, limits, fast, out)
    })
}

/// Runs the fast path and completes it; the exact stages where the fast path does not apply.
fn run_mikktspace(
    mesh: &Mesh<'_>,
    options: &MikkTSpaceOptions,
    limits: RunLimits<'_>,
    fast: &mut FastPath,
    out: &mut [[f32; 4]],
) -> Report {
    if !fast.run(mesh, options, limits, out) {
        mikktspace::run(mesh, options, limits, out)
    } else if limits.is_cancelled() {
        Report::default()
    } else {
        submesh::complete(mesh, options, fast, limits, out)
    }
}

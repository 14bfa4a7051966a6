//! The entry points of tangent generation, which run the method that the options name.

pub(crate) mod fast;
mod frames;
pub(crate) mod generate;
pub(crate) mod memory;
mod method_plan;
pub(crate) mod methods;
pub(crate) mod mikktspace;
mod options;
mod orthogonalize;
mod output;
mod repair;
mod report;
pub(crate) mod submesh;

use crate::Context;
use crate::Error;
use crate::Mesh;

pub use crate::tangents::frames::{
    CompactFrames, Frames, generate_compact_frames, generate_frames, generate_frames_with, write_frames,
};
pub use crate::tangents::generate::Tangents;
use crate::tangents::generate::{generate, run};
pub(crate) use crate::tangents::method_plan::MethodPlan;
pub use crate::tangents::options::{Method, MikkTSpaceOptions, Mode, TangentOptions};
pub use crate::tangents::report::Report;

/// Computes the tangent of every corner.
pub fn generate_tangents(mesh: &Mesh<'_>, options: &TangentOptions) -> Tangents {
    let mut context = Context::new();
    let (limits, memory) = context.limits_and_memory();
    generate(mesh, options, limits, memory)
}

/// As [`generate_tangents`], with a context. Errors: the context's token was cancelled.
pub fn generate_tangents_with(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    context: &mut Context,
) -> Result<Tangents, Error> {
    let (limits, memory) = context.limits_and_memory();
    let tangents = generate(mesh, options, limits, memory);
    limits.check().map(|()| tangents)
}

/// As [`generate_tangents_with`], into the caller's array.
///
/// Repeated calls of MikkTSpace on one thread allocate only what vertices of the general path need
/// (UV-degenerate, split or mirrored fans; degenerate triangles).
/// `corners`: receives one tangent per corner, in corner order, which is not vertex order; unspecified after
/// cancellation. Errors: an array of another length; the context's token was cancelled.
pub fn write_tangents(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    context: &mut Context,
    corners: &mut [[f32; 4]],
) -> Result<Report, Error> {
    Error::check_output("tangents", mesh.corner_count(), corners.len())?;
    let (limits, memory) = context.limits_and_memory();
    let report = run(mesh, options, limits, memory, corners);
    limits.check().map(|()| report)
}

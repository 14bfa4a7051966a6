//! Options to method: the entry points of tangent generation.

pub(crate) mod angle_area;
mod face;
pub(crate) mod fast;
mod frames;
mod from_normal;
mod mesh_slices;
mod method;
mod method_buffers;
mod method_plan;
pub(crate) mod mikktspace;
mod mirrored_edges;
mod options;
mod orthogonalize;
mod output;
mod repair;
mod report;
pub(crate) mod submesh;
mod uv_derivatives;
mod vertex_sums;

use crate::CornerFrames;
use crate::CornerTangents;
use crate::Mesh;
use crate::MeshError;
use crate::cancel::Stop;
use crate::math::cosine_of_degrees;
use crate::split::expect;

use crate::exec::simd::Width;
pub use crate::exec::simd::WidthLimit;
pub use crate::exec::threads::on_this_thread;
use crate::tangents::fast::{Fans, LARGEST_COSINE};
use crate::tangents::frames::FrameMemory;
pub use crate::tangents::frames::{LentFrames, generate_frames, lend_frames, write_frames};
use crate::tangents::method_buffers::MethodBuffers;
pub(crate) use crate::tangents::method_plan::Planned;
pub use crate::tangents::options::{Method, Mode, TangentOptions};
pub use crate::tangents::report::Report;

/// Tangents of corners and the report of the run.
#[derive(Clone, Debug, Default)]
pub struct Tangents {
    /// One tangent per corner.
    pub corners: CornerTangents,
    /// What was met on the way.
    pub report: Report,
}

/// Frames of corners and the report of the run.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    /// One frame per corner.
    pub corners: CornerFrames,
    /// What was met on the way.
    pub report: Report,
}

/// Memory that runs of [`generate_tangents_into`] keep from one to the next.
#[derive(Debug, Default)]
pub struct Scratch {
    fans: Fans,
    sums: MethodBuffers,
    frames: FrameMemory,
    width_limit: WidthLimit,
}

impl Scratch {
    /// An empty one; it grows to what the largest mesh needs.
    pub fn new() -> Self {
        Self::default()
    }

    /// One whose runs use no wider vector instructions than `limit`. The width never shows in a result: this is for comparing.
    pub fn with_width_limit(limit: WidthLimit) -> Self {
        Self { width_limit: limit, ..Self::default() }
    }
}

/// Computes the tangent of every corner.
pub fn generate_tangents(mesh: &Mesh<'_>, options: &TangentOptions) -> Tangents {
    let mut out = Tangents::default();
    generate_tangents_into(mesh, options, &mut Scratch::new(), &mut out);
    out
}

/// As [`generate_tangents`], into `out`, whose memory is used again, as is that of `scratch`: repeated calls of MikkTSpace on one thread
/// allocate only what vertices of the general path need (UV-degenerate, split or mirrored fans; degenerate triangles). Memory stays as large as the
/// largest mesh and method needed it.
pub fn generate_tangents_into(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    scratch: &mut Scratch,
    out: &mut Tangents,
) {
    out.corners.0.resize(mesh.corner_count(), [0.0; 4]);
    out.report = run(mesh, options, &Stop::heard(), scratch, &mut out.corners.0);
}

/// As [`generate_tangents_into`], into an array of the caller's, for bindings and buffers that are not a `Vec`.
///
/// `corners`: receives one tangent per corner, in corner order, which is not vertex order. Errors: an array of another length; a run that
/// was [cancelled](crate::Cancel::run), which leaves anything in `corners`.
pub fn write_tangents(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    scratch: &mut Scratch,
    corners: &mut [[f32; 4]],
) -> Result<Report, MeshError> {
    expect("corners", mesh.corner_count(), corners.len())?;
    let stop = Stop::heard();
    let report = run(mesh, options, &stop, scratch, corners);
    stop.check().map(|()| report)
}

/// Asks for the method where the caller is, so that a program whose method is constant carries no other.
#[inline(always)]
fn run(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    stop: &Stop,
    scratch: &mut Scratch,
    out: &mut [[f32; 4]],
) -> Report {
    let width = Width::widest(scratch.width_limit);
    if options.method != Method::MikkTSpace {
        return method::run(mesh, options, stop, width, &mut scratch.sums, out);
    }
    mikktspace_of_corners(mesh, options, stop, width, scratch, out)
}

fn mikktspace_of_corners(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    stop: &Stop,
    width: Width,
    scratch: &mut Scratch,
    out: &mut [[f32; 4]],
) -> Report {
    if has_whole_fans(options) && scratch.fans.run(mesh, options, width, stop, out) {
        if stop.is_asked() {
            Report::default()
        } else {
            submesh::decide(mesh, options, &scratch.fans, stop, out)
        }
    } else {
        method::mikktspace(mesh, options, stop, out)
    }
}

/// Whether the fast path may apply: where not all fans may split by their angles.
fn has_whole_fans(options: &TangentOptions) -> bool {
    options.method == Method::MikkTSpace && cosine_of_degrees(options.threshold) < LARGEST_COSINE
}

//! Completes a run that a GPU started: decides the vertices that the GPU left undecided.
//!
//! For `darboux-gpu` and the npm package. Not part of the API.

use crate::Context;
use crate::Error;
use crate::Mesh;
use crate::MikkTSpaceOptions;
use crate::Report;
use crate::math::cosine_of_degrees;

use crate::tangents::fast::FastPath;
use crate::tangents::submesh;

pub use crate::tangents::fast::UNDECIDED;

/// Decides the undecided vertices. Returns the report of the whole mesh, and the number of corners that were
/// undecided. Errors: the context's token was cancelled.
///
/// `mesh`: indexed triangles with finite values. `welded`: for each vertex the first vertex with equal bits.
/// `out`: one tangent per corner; the sign [`UNDECIDED`] marks all corners of vertices that the GPU did not
/// decide. A GPU must leave undecided: vertices whose triangles are not one group and one subgroup, vertices
/// of UV-degenerate triangles, vertices without a usable tangent, and corners of degenerate triangles.
pub fn complete(
    mesh: &Mesh<'_>,
    options: &MikkTSpaceOptions,
    welded: Vec<u32>,
    context: &mut Context,
    out: &mut [[f32; 4]],
) -> Result<(Report, usize), Error> {
    let limits = context.limits();
    let mut fast = FastPath::default();
    fast.resume(mesh, options.mode, welded, out);
    limits.check()?;
    let corners = fast.undecided(mesh).flatten().map(|corner| out[corner as usize]);
    let left = corners.filter(|corner| corner[3] == UNDECIDED).count();
    let report = submesh::decide(mesh, options, &fast, limits, out);
    limits.check().map(|()| (report, left))
}

/// The cosine of the threshold. Directions join when their cosines exceed it.
pub fn threshold_cosine(options: &MikkTSpaceOptions) -> f32 {
    cosine_of_degrees(options.threshold)
}

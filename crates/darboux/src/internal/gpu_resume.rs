//! Tangents that another machine began, for `darboux-gpu`. Not part of the API.

use crate::Mesh;
use crate::Report;
use crate::TangentOptions;
use crate::exec::limits::RunLimits;
use crate::math::cosine_of_degrees;

use crate::tangents::fast::FastPath;
use crate::tangents::submesh;

pub use crate::tangents::fast::UNDECIDED;

/// Decides the vertices that are left, and makes the report of the whole mesh.
///
/// `mesh`: indexed triangles, finite. `welded`: the first vertex that equals each vertex, the signs of zeros included. `out`: the tangents
/// of vertices whose triangles are one group and one subgroup; [`UNDECIDED`] signs at all corners of the others, among which are those of
/// UV-degenerate triangles and those without a usable tangent, and at the corners of degenerate triangles.
/// Returns how many corners were decided here, too.
pub fn complete(
    mesh: &Mesh<'_>,
    options: &TangentOptions,
    welded: Vec<u32>,
    out: &mut [[f32; 4]],
) -> (Report, usize) {
    let mut fast = FastPath::default();
    fast.resume(mesh, options.mode, welded, out);
    let corners = fast.undecided(mesh).flatten().map(|corner| out[corner as usize]);
    let left = corners.filter(|corner| corner[3] == UNDECIDED).count();
    (submesh::decide(mesh, options, &fast, RunLimits::default(), out), left)
}

/// The cosine above which directions are nearer than the threshold.
pub fn threshold_cosine(options: &TangentOptions) -> f32 {
    cosine_of_degrees(options.threshold)
}

//! How many corners each path of tangent generation decides. For the benchmark of real models.

use crate::Context;
use crate::Mesh;
use crate::MikkTSpaceOptions;

use crate::tangents::fast::{FastPath, UNDECIDED};

/// The corners of a mesh by the path that decides them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PathCounts {
    /// Decided by the first pass over the triangles.
    pub first_pass: usize,
    /// Decided from the groups around their vertices.
    pub groups: usize,
    /// Left to the general path, the exact stages.
    pub general: usize,
}

/// Runs the fast path and counts what it decides. All corners count as general where it does not apply.
pub fn path_counts(mesh: &Mesh<'_>, options: &MikkTSpaceOptions, context: &Context) -> PathCounts {
    let (limits, mut fast) = (context.limits(), FastPath::default());
    let mut out = vec![[0.0; 4]; mesh.corner_count()];
    if !fast.run(mesh, options, limits, &mut out) {
        return PathCounts { general: out.len(), ..PathCounts::default() };
    }
    let count_undecided = |out: &[[f32; 4]]| out.iter().filter(|tangent| tangent[3] == UNDECIDED).count();
    let after_first_pass = count_undecided(&out);
    fast.resolve(mesh, options, limits, &mut out, None);
    let general = count_undecided(&out);
    PathCounts { first_pass: out.len() - after_first_pass, groups: after_first_pass - general, general }
}

//! Completes a run of MikkTSpace that a GPU started, for `darboux/webgpu`.

use darboux::internal::gpu_resume;

use crate::arena::{Arena, with_arena};
use crate::options::mikkt_options;

/// The cosine of an angular threshold, which the shaders compare with.
#[unsafe(no_mangle)]
pub extern "C" fn threshold_cosine(threshold: f32) -> f32 {
    gpu_resume::threshold_cosine(&mikkt_options(0, threshold))
}

/// Computes the tangents that the GPU left open, in the array of given tangents, from `welded_vertices`. The
/// mesh is indexed and of triangles. Returns the number of corners computed here, or -1 where an index is out
/// of range.
#[unsafe(no_mangle)]
pub extern "C" fn complete_tangents(mode: u32, threshold: f32) -> i32 {
    with_arena(|arena| {
        let mut tangents = std::mem::take(&mut arena.extras.given_tangents);
        let welded = std::mem::take(&mut arena.extras.welded_vertices);
        let Arena { vertices, surface, report, context, extras, .. } = arena;
        let Some(mesh) = vertices.mesh(surface) else { return -1 };
        let (options, out) = (mikkt_options(mode, threshold), tangents.as_chunks_mut().0);
        let Ok((counts, corners)) = gpu_resume::complete(&mesh, &options, welded, context, out) else {
            return -1;
        };
        (extras.given_tangents, *report) = (tangents, counts);
        corners as i32
    })
}

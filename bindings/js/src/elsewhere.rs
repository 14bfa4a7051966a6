//! Tangents that a GPU began, for `darboux/webgpu`.

use darboux::internal::gpu_resume;

use crate::room::{sized, with};
use crate::tangents::options;

/// The cosine that shaders compare with.
#[unsafe(no_mangle)]
pub extern "C" fn threshold_cosine(threshold: f32) -> f32 {
    gpu_resume::threshold_cosine(&options(0, threshold, 0))
}

/// Where the first vertex that equals each is written.
#[unsafe(no_mangle)]
pub extern "C" fn welded(vertices: usize) -> *mut u32 {
    with(|room| sized(&mut room.values.welded, vertices))
}

/// Decides the vertices that the given tangents leave open, in their place: how many corners these have, or -1 where the mesh is not one.
/// It is indexed and of triangles.
#[unsafe(no_mangle)]
pub extern "C" fn complete_tangents(mode: u32, threshold: f32) -> i32 {
    with(|room| {
        let (mut begun, welded) =
            (std::mem::take(&mut room.values.given), std::mem::take(&mut room.values.welded));
        let Some(mesh) = room.mesh() else { return -1 };
        let tangents = begun.as_chunks_mut().0;
        let (report, corners) = gpu_resume::complete(&mesh, &options(mode, threshold, 0), welded, tangents);
        (room.values.given, room.tangents.report) = (begun, report);
        corners as i32
    })
}

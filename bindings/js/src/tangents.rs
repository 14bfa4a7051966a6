//! `generateTangents`: one tangent per corner.

use darboux::write_tangents;

use crate::arena::{Arena, with_arena};
use crate::options::tangent_options;

/// Computes the tangents of all corners and returns their address (four floats per corner), or null where an
/// index is out of range.
#[unsafe(no_mangle)]
pub extern "C" fn generate_tangents(mode: u32, threshold: f32, method: u32) -> *const f32 {
    let options = tangent_options(mode, threshold, method);
    with_arena(|arena| {
        let Arena { vertices, surface, tangents, report, context, .. } = arena;
        let Some(mesh) = vertices.mesh(surface) else { return std::ptr::null() };
        tangents.resize(mesh.corner_count(), [0.0; 4]);
        let Ok(counts) = write_tangents(&mesh, &options, context, tangents) else { return std::ptr::null() };
        *report = counts;
        tangents.as_ptr().cast()
    })
}

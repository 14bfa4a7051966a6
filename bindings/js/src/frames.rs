//! `generateFrames`: tangent, bitangent and magnitudes of every corner.

use darboux::generate_frames as generate;

use crate::arena::with_arena;
use crate::extras::FrameArrays;
use crate::options::tangent_options;

/// Computes the frames of all corners and returns the address of their tangents (four floats per corner), or
/// null where an index is out of range. Options are those of `generate_tangents`.
#[unsafe(no_mangle)]
pub extern "C" fn generate_frames(mode: u32, threshold: f32, method: u32) -> *const f32 {
    with_arena(|arena| {
        let Some(mesh) = arena.mesh() else { return std::ptr::null() };
        let made = generate(&mesh, &tangent_options(mode, threshold, method));
        let frames = made.corners.per_corner();
        arena.extras.frames = FrameArrays {
            tangents: frames.iter().map(|frame| frame.tangent_and_sign()).collect(),
            bitangents: frames.iter().map(|frame| frame.bitangent).collect(),
            magnitudes: frames.iter().map(|frame| frame.magnitude).collect(),
        };
        arena.report = made.report;
        arena.extras.frames.tangents.as_ptr().cast()
    })
}

/// Three floats per corner.
#[unsafe(no_mangle)]
pub extern "C" fn frame_bitangents() -> *const f32 {
    with_arena(|arena| arena.extras.frames.bitangents.as_ptr().cast())
}

/// Two floats per corner.
#[unsafe(no_mangle)]
pub extern "C" fn frame_magnitudes() -> *const f32 {
    with_arena(|arena| arena.extras.frames.magnitudes.as_ptr().cast())
}

//! Whole frames of corners.

use darboux::generate_frames as generate;

use crate::room::with;
use crate::tangents::options;

/// The parts of frames, one of each per corner.
#[derive(Default)]
pub struct Frames {
    tangents: Vec<[f32; 4]>,
    bitangents: Vec<[f32; 3]>,
    magnitudes: Vec<[f32; 2]>,
}

/// Computes the frames of all corners: where their tangents lie, or null where the mesh is not one. Choices come as those of
/// `generate_tangents`.
#[unsafe(no_mangle)]
pub extern "C" fn generate_frames(mode: u32, threshold: f32, method: u32) -> *const f32 {
    with(|room| {
        let Some(mesh) = room.mesh() else { return std::ptr::null() };
        let made = generate(&mesh, &options(mode, threshold, method));
        let frames = made.corners.per_corner();
        room.values.frames = Frames {
            tangents: frames.iter().map(|frame| frame.tangent_and_sign()).collect(),
            bitangents: frames.iter().map(|frame| frame.bitangent).collect(),
            magnitudes: frames.iter().map(|frame| frame.magnitude).collect(),
        };
        room.tangents.report = made.report;
        room.values.frames.tangents.as_ptr().cast()
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn frame_bitangents() -> *const f32 {
    with(|room| room.values.frames.bitangents.as_ptr().cast())
}

#[unsafe(no_mangle)]
pub extern "C" fn frame_magnitudes() -> *const f32 {
    with(|room| room.values.frames.magnitudes.as_ptr().cast())
}

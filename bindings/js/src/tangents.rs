//! Tangents of corners.

use darboux::{Mode, Scratch, TangentOptions, generate_tangents_into};

use crate::room;

/// Computes the tangents of all corners: where they lie, or null where the mesh is not one.
#[unsafe(no_mangle)]
pub extern "C" fn generate_tangents(mode: u32, threshold: f32) -> *const f32 {
    let mode = match mode {
        0 => Mode::Reference,
        1 => Mode::Repaired,
        _ => Mode::Corrected,
    };
    let options = TangentOptions { mode, threshold, ..TangentOptions::default() };
    room::with(|room| {
        let mut tangents = std::mem::take(&mut room.tangents);
        let Some(mesh) = room.mesh() else { return std::ptr::null() };
        generate_tangents_into(&mesh, &options, &mut Scratch::new(), &mut tangents);
        room.tangents = tangents;
        room.tangents.corners.per_corner().as_ptr().cast()
    })
}

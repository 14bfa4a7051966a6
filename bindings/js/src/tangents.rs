//! Tangents of corners.

use darboux::{Method, Mode, TangentOptions, generate_tangents_into};

use crate::room::{Room, with};

/// Computes the tangents of all corners: where they lie, or null where the mesh is not one. Choices come as their places in the
/// lists of `lib`.
#[unsafe(no_mangle)]
pub extern "C" fn generate_tangents(mode: u32, threshold: f32, method: u32) -> *const f32 {
    let options = options(mode, threshold, method);
    with(|room| {
        let Room { vertices, surface, tangents, scratch, .. } = room;
        let Some(mesh) = vertices.mesh(surface) else { return std::ptr::null() };
        generate_tangents_into(&mesh, &options, scratch, tangents);
        tangents.corners.per_corner().as_ptr().cast()
    })
}

/// Choices as numbers.
pub fn options(mode: u32, threshold: f32, method: u32) -> TangentOptions {
    let mode = match mode {
        0 => Mode::Reference,
        1 => Mode::Repaired,
        _ => Mode::Corrected,
    };
    TangentOptions { method: self::method(method), mode, threshold }
}

#[cfg(feature = "full")]
fn method(code: u32) -> Method {
    match code {
        0 => Method::MikkTSpace,
        1 => Method::AngleArea,
        2 => Method::Lengyel,
        3 => Method::LengyelPerVertex,
        4 => Method::Average,
        5 => Method::Area,
        6 => Method::Face,
        _ => Method::FromNormal,
    }
}

/// Alone in this module.
#[cfg(not(feature = "full"))]
fn method(_code: u32) -> Method {
    Method::MikkTSpace
}

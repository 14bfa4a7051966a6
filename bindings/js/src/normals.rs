//! Normals of corners.

use darboux::{NormalOptions, NormalWeight, Shading, SmoothingSeams, generate_normals as generate};

use crate::room::with;

/// Computes the normals of all corners: where they lie, or null where the mesh is not one. Choices come as their places in the
/// lists of `lib/darboux.ts`.
#[unsafe(no_mangle)]
pub extern "C" fn generate_normals(shading: u32, weight: u32, crease: f32, seams: u32) -> *const f32 {
    let options = NormalOptions {
        shading: if shading == 0 { Shading::Flat } else { Shading::Smooth },
        weight: match weight {
            0 => NormalWeight::Angle,
            1 => NormalWeight::Area,
            _ => NormalWeight::AngleArea,
        },
        crease,
        seams: if seams == 0 { SmoothingSeams::Ignored } else { SmoothingSeams::Respected },
    };
    with(|room| {
        let made =
            generate(room.vertices.positions(), room.surface.indices(), room.surface.faces(), &options);
        let Ok(normals) = made else { return std::ptr::null() };
        room.values.floats = normals.corners.into_flattened();
        room.values.floats.as_ptr()
    })
}

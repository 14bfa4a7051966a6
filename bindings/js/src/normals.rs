//! `generateNormals`: one normal per corner.

use darboux::{NormalOptions, NormalWeight, Shading, SmoothingSeams, generate_normals as generate};

use crate::arena::with_arena;

/// Computes the normals of all corners and returns their address (three floats per corner), or null where an index is out of range.
/// Options are positions in the lists of names in `lib/darboux.ts`.
#[unsafe(no_mangle)]
pub extern "C" fn generate_normals(shading: u32, weight: u32, crease: f32, seams: u32) -> *const f32 {
    let weight = match weight {
        0 => NormalWeight::Angle,
        1 => NormalWeight::Area,
        _ => NormalWeight::AngleArea,
    };
    let options = NormalOptions::new()
        .with_shading(if shading == 0 { Shading::Flat } else { Shading::Smooth })
        .with_weight(weight)
        .with_crease(crease)
        .with_seams(if seams == 0 { SmoothingSeams::Ignored } else { SmoothingSeams::Respected });
    with_arena(|arena| {
        let (positions, surface) = (arena.vertices.positions(), &arena.surface);
        let made = generate(positions, surface.indices(), surface.faces(), &options);
        let Ok(normals) = made else { return std::ptr::null() };
        arena.extras.floats = normals.corners.into_per_corner().into_flattened();
        arena.extras.floats.as_ptr()
    })
}

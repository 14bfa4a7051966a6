//! `generateNormals`: one normal per corner.

use darboux::{NormalOptions, generate_normals as generate};

use crate::arena::with_arena;
use crate::options::choice;

/// Computes the normals of all corners and returns their address (three floats per corner), or null where an
/// index is out of range. Options are positions in the lists of `lib/core/choices.ts`.
#[unsafe(no_mangle)]
pub extern "C" fn generate_normals(shading: u32, weight: u32, crease: f32, seams: u32) -> *const f32 {
    let options = NormalOptions::new()
        .with_shading(choice(shading))
        .with_weight(choice(weight))
        .with_crease(crease)
        .with_seams(choice(seams));
    with_arena(|arena| {
        let (positions, surface) = (arena.vertices.positions(), &arena.surface);
        let made = generate(positions, surface.indices(), surface.faces(), &options);
        let Ok(normals) = made else { return std::ptr::null() };
        arena.extras.floats = normals.corners.into_per_corner().into_flattened();
        arena.extras.floats.as_ptr()
    })
}

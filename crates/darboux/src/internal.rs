//! What other crates of this workspace need and users do not. No promise of stability.

pub mod cancel_checks;
pub mod gpu_plan;
pub mod gpu_resume;
pub mod jobs;
pub mod paths;
pub mod stage_arrays;
pub mod vectors;
pub mod vertex_progress;
pub mod width_limit;

pub use crate::measure::{DifferenceSums, triangle_area};
pub use crate::recipe::recipe_tangents;
pub use crate::util::union_find::DisjointSets;

/// Whether MikkTSpace cuts a quad from corner 1 to 3, rather than from 0 to 2.
pub fn is_quad_cut_across(uvs: [[f32; 2]; 4], positions: [[f32; 3]; 4]) -> bool {
    crate::topology::triangulate::is_cut_across(uvs, || positions)
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub use crate::util::random::seed_random;

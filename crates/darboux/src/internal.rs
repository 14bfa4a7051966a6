//! What other crates of this workspace need and users do not. No promise of stability.

pub mod cancel_checks;
pub mod gpu_plan;
pub mod gpu_resume;
pub mod jobs;
pub mod paths;
pub mod stage_arrays;
pub mod vertex_progress;
pub mod width_limit;

pub use crate::measure::{DifferenceSums, triangle_area};
pub use crate::recipe::recipe_tangents;

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub use crate::util::random::seed_random;

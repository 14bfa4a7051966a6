//! Comparison of two sets of tangents, and of tangents with the derivatives of the UV map.

mod angle;
mod difference;
mod fidelity;

pub use difference::{
    CornerDifference, DifferenceSums, TangentDifference, measure_tangents, measure_tangents_with,
};
pub use fidelity::{UvFidelity, measure_uv_fidelity, measure_uv_fidelity_with, triangle_area};

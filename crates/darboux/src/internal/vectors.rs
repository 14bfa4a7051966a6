//! The vector functions of the core, so that other crates need none of their own.

/// Three floats; every operation is rounded to `f32` in the order written.
pub mod single {
    pub use crate::math::{V3, cross, dot, sub};
}

/// Three doubles.
pub mod double {
    pub use crate::math_f64::{D3, add_scaled, cross, dot, length, sub, unit};
}

//! Conventions: what the numbers of a mesh and of its normal map mean, and how they change from one program
//! to another.
//!
//! docs/conventions.md derives the rules and tabulates the presets.

mod conversion;
mod presets;
mod rules;
mod text;

pub use conversion::Conversion;
pub use rules::{
    Axes, Axis, BitangentDirection, Convention, Handedness, SignRule, TangentDirection, UvOrigin, Winding,
};
pub use text::ConventionError;

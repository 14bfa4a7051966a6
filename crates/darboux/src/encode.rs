//! Tangents and normals in fewer bytes, and back.
//!
//! | encoding | bytes | what | largest error of a direction |
//! |---|---|---|---|
//! | `[f32; 4]` | 16 | tangent | none |
//! | [`tangent_to_snorm16`] | 8 | tangent | 0.0016 degrees |
//! | [`tangent_to_snorm8`] | 4 | tangent | 0.40 degrees |
//! | [`tangent_to_snorm10`] | 4 | tangent | 0.098 degrees |
//! | [`tangent_to_octahedral`] | 4 | tangent | 0.0057 degrees |
//! | [`normal_to_octahedral`] | 4 | normal | 0.0038 degrees |
//! | [`tangent_to_diamond`] | 2 | tangent, given the decoded normal | 0.0071 degrees |
//! | [`frame_to_quaternion`] | 8 | tangent and normal | 0.0047 degrees |
//!
//! The sign is exact in all of them: a w below zero counts as -1, any other as +1. What has no direction, or is not finite, becomes
//! *some* direction, or zero in the forms that can hold it. `shaders/` holds the same decoders for GPUs; no decoder needs more than
//! + - * / and sqrt, so that vertices of one direction agree everywhere.

mod diamond;
mod octahedral;
mod quaternion;
mod snorm;

pub use diamond::{tangent_from_diamond, tangent_to_diamond};
pub use octahedral::{
    normal_from_octahedral, normal_to_octahedral, tangent_from_octahedral, tangent_to_octahedral,
};
pub use quaternion::{frame_from_quaternion, frame_to_quaternion};
pub use snorm::{
    tangent_from_snorm8, tangent_from_snorm10, tangent_from_snorm16, tangent_to_snorm8, tangent_to_snorm10,
    tangent_to_snorm16,
};

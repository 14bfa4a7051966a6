//! Compact encodings of tangents and normals.
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
//! The sign is exact in all of them: w below zero decodes to -1, any other w to +1. A vector that is zero or
//! not finite decodes to an unspecified direction, or to zero in encodings that can represent it. `shaders/`
//! has the same decoders for GPUs. Decoders use only
//! + - * / and sqrt, so that results agree between platforms.

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

use crate::choice;

/// The encodings of tangents that have a name in the bindings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// `[i8; 4]`: [`tangent_to_snorm8`].
    Snorm8,
    /// `u32`: [`tangent_to_snorm10`].
    Snorm10,
    /// `[i16; 4]`: [`tangent_to_snorm16`].
    Snorm16,
    /// `[i16; 2]`: [`tangent_to_octahedral`].
    Octahedral,
    /// `u16`: [`tangent_to_diamond`]. The decoder needs the same normal.
    Diamond,
}

choice! { Encoding, "encoding",
    Snorm8 => "snorm8", "four bytes: components times 127";
    Snorm10 => "snorm10", "four bytes: ten bits for each component, two for the sign";
    Snorm16 => "snorm16", "eight bytes: components times 32767";
    Octahedral => "octahedral", "four bytes: octahedral coordinates, the lowest bit is the sign";
    Diamond => "diamond", "two bytes: an angle around the normal, the lowest bit is the sign";
}

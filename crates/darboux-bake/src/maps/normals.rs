//! Normals and bent normals in tangent space.

use crate::found::Found;
use crate::vector::{Vector, length, scale};

/// The normal in the frame of the low surface; up where the frame is degenerate.
pub fn tangent(found: &Found<'_>) -> Vector {
    found.normal.unwrap_or([0.0, 0.0, 1.0])
}

/// A bent normal in the frame of the low surface, of the same length.
pub fn bent(found: &Found<'_>, bent: Vector) -> Vector {
    found.low.frame.to_tangent_space(bent).map_or([0.0, 0.0, 1.0], |direction| scale(length(bent), direction))
}

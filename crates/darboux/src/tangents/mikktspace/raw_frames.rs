//! The frames of all corners before repair.

use crate::Frame;
use crate::math::V3;

/// The frame of corners that nothing writes, as mikktspace.c initialises it.
pub(crate) const DEFAULT_FRAME: Frame =
    Frame { tangent: [1.0, 0.0, 0.0], bitangent: [0.0, 1.0, 0.0], magnitude: [1.0, 1.0], sign: -1.0 };

/// The frame of every corner, and what repairs need.
#[derive(Debug)]
pub(crate) struct RawFrames {
    pub of_corner: Vec<Frame>,
    /// For corners with an unusable tangent, the mean of their subgroup's tangents. Zero where that has no
    /// direction, and for all other corners.
    pub mean_of_corner: Vec<V3>,
}

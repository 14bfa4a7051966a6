//! A direction of the world in the frame of the low surface: where up is, for rain, dust and gravity.

use crate::found::LowSample;
use crate::frame::ShadingFrame;
use crate::vector::{Vector, wide};

/// The direction; up in tangent space where the frame is degenerate.
pub fn direction(sample: &LowSample<'_>) -> Vector {
    let frame = ShadingFrame::new(sample.point, sample.options.bitangent);
    frame.to_tangent_space(wide(sample.options.world_direction)).unwrap_or([0.0, 0.0, 1.0])
}

//! The edges of the low surface's triangles.

use crate::found::LowSample;

/// Half the width of a line in texels, and how far it fades.
const HALF_WIDTH: f64 = 0.5;
const FADE: f64 = 0.5;

/// 1 on a line, 0 beside it.
pub fn line(sample: &LowSample<'_>) -> f64 {
    let distance = sample.face.distance_to_edges(sample.place);
    ((HALF_WIDTH + FADE - distance) / FADE).clamp(0.0, 1.0)
}

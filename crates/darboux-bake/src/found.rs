//! What maps are computed from: a hit on a high surface, and a sample on the low one.

use crate::BakeOptions;
use crate::bvh::Hit;
use crate::charts::Charts;
use crate::face::Face;
use crate::frame::ShadingFrame;
use crate::high::{HighGroup, HighPoint};
use crate::point::SurfacePoint;
use crate::rays::SampleRay;
use crate::texel::Sample;
use crate::vector::Vector;

/// A sample's ray, and what the maps need of the low surface.
#[derive(Clone, Copy, Debug)]
pub struct LowRay {
    pub ray: SampleRay,
    /// The place on the low surface.
    pub position: Vector,
    /// The frame of the low surface.
    pub frame: ShadingFrame,
    /// The sides of the sample's area on the low surface; zeros unless
    /// [`MapList::needs_sides`](crate::maps::MapList::needs_sides).
    pub sides: [Vector; 2],
}

/// What a sample's ray has found.
pub struct Found<'a> {
    pub low: &'a LowRay,
    pub group: &'a HighGroup<'a>,
    pub hit: &'a Hit,
    pub high: HighPoint,
    /// The place of the hit.
    pub position: Vector,
    /// The distance of the high surface from the low one, positive outside.
    pub height: f64,
    /// The normal in the frame of the low surface; none where the frame is degenerate.
    pub normal: Option<Vector>,
    pub options: &'a BakeOptions,
    /// For random choices.
    pub seed: u64,
}

impl Found<'_> {
    /// What a texel counts of the hit. `is_extended`: whether the texel lies in the gutter of the chart.
    pub fn sample(&self, is_extended: bool) -> Sample {
        Sample { normal: self.normal, is_inverted: self.high.is_inverted, is_extended }
    }
}

/// A sample on the low surface.
pub struct LowSample<'a> {
    pub face: &'a Face<'a>,
    pub point: &'a SurfacePoint,
    /// In texels.
    pub place: [f64; 2],
    pub charts: &'a Charts,
    pub options: &'a BakeOptions,
}

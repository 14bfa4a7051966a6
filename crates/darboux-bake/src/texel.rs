//! Stage 6: the samples of a texel become its content.

use crate::images::TexelState;
use crate::vector::{Vector, add_scaled, unit};

/// What a sample adds to its texel besides the numbers of maps.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// In tangent space; `None` where the frame is degenerate.
    pub normal: Option<Vector>,
    pub is_inverted: bool,
    /// Whether the sample lies in the gutter, on the continued surface.
    pub is_extended: bool,
}

/// The counts over the samples of a texel.
#[derive(Clone, Copy, Debug, Default)]
pub struct TexelSums {
    pub is_overlapped: bool,
    pub hits_back: bool,
    pub is_inverted: bool,
    pub is_frameless: bool,
    /// Samples in charts.
    pub charted: u32,
    /// Hits of samples in charts.
    charted_hits: u32,
    /// All hits.
    hits: u32,
    /// The sum of normals in tangent space.
    normal: Vector,
}

impl TexelSums {
    pub fn add(&mut self, sample: &Sample) {
        self.hits += 1;
        self.charted_hits += u32::from(!sample.is_extended);
        self.is_inverted |= sample.is_inverted && !sample.is_extended;
        self.is_frameless |= sample.normal.is_none();
        self.normal = add_scaled(self.normal, 1.0, sample.normal.unwrap_or([0.0, 0.0, 1.0]));
    }

    pub fn state(&self) -> TexelState {
        match (self.charted, self.charted_hits, self.hits) {
            (0, _, 0) => TexelState::Outside,
            (0, ..) => TexelState::Extended,
            (_, 0, _) if self.hits_back => TexelState::MissedBehind,
            (_, 0, _) => TexelState::Missed,
            _ => TexelState::Baked,
        }
    }

    /// Whether the mean of normals points below the surface.
    pub fn is_below_horizon(&self) -> bool {
        self.normal[2] < 0.0 && unit(self.normal).is_some_and(|normal| normal[2] < 0.0)
    }

    /// 1 over the number of hits, and 1 over the number of samples on the low surface; none where there are
    /// none.
    pub fn shares(&self) -> [Option<f64>; 2] {
        let extended = self.hits - self.charted_hits;
        let share = |count: u32| (count > 0).then(|| 1.0 / f64::from(count));
        [share(if self.state().has_content() { self.hits } else { 0 }), share(self.charted + extended)]
    }
}

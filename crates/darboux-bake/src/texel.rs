//! Stage 6: the samples of a texel become its content.

use crate::images::TexelState;
use crate::vector::{Vector, add_scaled, unit};

/// What a sample found on the high surface.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// In tangent space; `None` where the frame is degenerate.
    pub normal: Option<Vector>,
    pub object_normal: Vector,
    pub height: f64,
    pub occlusion: f64,
    pub position: Vector,
    pub is_inverted: bool,
    /// Whether the sample lies beyond the chart, on the continued surface.
    pub is_extended: bool,
}

/// The sums over the samples of a texel.
#[derive(Clone, Copy, Debug, Default)]
pub struct TexelSums {
    pub is_charted: bool,
    pub is_overlapped: bool,
    pub hits_back: bool,
    pub is_inverted: bool,
    pub is_frameless: bool,
    /// Hits of samples in charts.
    charted_hits: u32,
    /// All hits.
    hits: u32,
    normal: Vector,
    object_normal: Vector,
    height: f64,
    occlusion: f64,
    position: Vector,
}

/// The content of a texel with hits.
#[derive(Clone, Copy, Debug)]
pub struct Texel {
    pub normal: Vector,
    pub object_normal: Vector,
    pub height: f64,
    pub occlusion: f64,
    pub position: Vector,
}

impl TexelSums {
    pub fn add(&mut self, sample: &Sample) {
        self.hits += 1;
        self.charted_hits += u32::from(!sample.is_extended);
        self.is_inverted |= sample.is_inverted && !sample.is_extended;
        self.is_frameless |= sample.normal.is_none();
        self.normal = add_scaled(self.normal, 1.0, sample.normal.unwrap_or([0.0, 0.0, 1.0]));
        self.object_normal = add_scaled(self.object_normal, 1.0, sample.object_normal);
        self.height += sample.height;
        self.occlusion += sample.occlusion;
        self.position = add_scaled(self.position, 1.0, sample.position);
    }

    pub fn state(&self) -> TexelState {
        match (self.is_charted, self.charted_hits, self.hits) {
            (true, 0, _) if self.hits_back => TexelState::MissedBehind,
            (true, 0, _) => TexelState::Missed,
            (true, ..) => TexelState::Baked,
            (false, _, 0) => TexelState::Outside,
            (false, ..) => TexelState::Extended,
        }
    }

    /// The means over the samples with hits; those of normals are normalised, and point up where they cancel.
    pub fn resolve(&self) -> Texel {
        let share = 1.0 / f64::from(self.hits.max(1));
        let up = [0.0, 0.0, 1.0];
        Texel {
            normal: unit(self.normal).unwrap_or(up),
            object_normal: unit(self.object_normal).unwrap_or(up),
            height: share * self.height,
            occlusion: share * self.occlusion,
            position: self.position.map(|x| share * x),
        }
    }
}

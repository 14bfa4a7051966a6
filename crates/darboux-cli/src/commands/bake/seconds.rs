//! Where the time of a bake goes.

use std::time::Instant;

use serde::Serialize;

/// Seconds of wall time by stage. json.txt documents the fields.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    pub reading: f64,
    pub building: f64,
    pub rays: f64,
    pub verifying: f64,
    pub writing: f64,
}

impl Seconds {
    /// The stages with what they are.
    pub fn stages(&self) -> [(&'static str, f64); 5] {
        [
            ("reading the models", self.reading),
            ("building trees and cages", self.building),
            ("rays", self.rays),
            ("--verify", self.verifying),
            ("encoding and writing", self.writing),
        ]
    }
}

/// Tells the time since it was last asked.
pub struct Clock(Instant);

impl Clock {
    pub fn start() -> Self {
        Self(Instant::now())
    }

    /// The seconds since the start, or since the last call.
    pub fn lap(&mut self) -> f64 {
        let seconds = self.0.elapsed().as_secs_f64();
        self.0 = Instant::now();
        seconds
    }
}

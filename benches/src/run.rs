//! What the benchmark asks of an engine that has been started on a mesh.

/// Unit tangent and bitangent sign of one corner.
pub type Tangent = [f32; 4];

/// An engine with its mesh and the memory that it reuses between calls.
pub trait Run {
    /// Computes the mesh's tangents `count` times. Errors: the engine's process has ended.
    fn run(&mut self, count: usize) -> Result<Time, String>;

    /// The tangent of each corner from the last call.
    fn tangents(&mut self) -> Result<Vec<Tangent>, String>;

    /// The number of tangents that a call gives: one per corner or one per vertex.
    fn output_len(&self) -> usize;
}

/// The duration of one or more calls in nanoseconds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Time {
    /// Wall time.
    pub wall: f64,
    /// Processor time of all threads of the process. For a single-threaded engine that is its own, because
    /// nothing else runs.
    pub cpu: f64,
}

impl Time {
    /// The time of one of `count` equal parts.
    pub fn divided_by(self, count: f64) -> Self {
        Self { wall: self.wall / count, cpu: self.cpu / count }
    }
}

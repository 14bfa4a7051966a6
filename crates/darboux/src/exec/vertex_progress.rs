//! Progress on a vertex with very many faces, whose tangents can take minutes.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// Progress on the current vertex with very many faces, shared by its clones. Of several such vertices at
/// once it shows the one that wrote last.
#[derive(Clone, Debug, Default)]
pub struct VertexProgress(Arc<AtomicU32>);

/// No vertex with very many faces is being computed.
const NONE: u32 = 0;

impl VertexProgress {
    /// The percentage of the vertex's faces that are done; `None` between such vertices.
    pub fn percent(&self) -> Option<u32> {
        self.0.load(Ordering::Relaxed).checked_sub(1)
    }

    pub(crate) fn set(&self, done: usize, total: usize) {
        self.0.store(1 + (100 * done as u64 / total.max(1) as u64) as u32, Ordering::Relaxed);
    }

    pub(crate) fn clear(&self) {
        self.0.store(NONE, Ordering::Relaxed);
    }
}

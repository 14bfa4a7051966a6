//! Stopping a run from another thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A request to stop, which its clones share: give one to [`Scratch::cancel_by`](crate::Scratch::cancel_by), keep one to
/// [`Cancel::cancel`] with.
///
/// It is for what can take its size squared, MikkTSpace's fans of many thousand triangles around one vertex below 180 degrees, and is heard
/// between their triangles. Other methods and stages, linear in the mesh, end first. Making a [`Plan`](crate::Plan) cannot be cancelled.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// One that nobody has asked for yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks for the stop, from any thread, for good.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// True once it was asked for.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

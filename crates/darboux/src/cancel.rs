//! Stopping a run from another thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A request to stop, which its clones share: give one to [`Scratch::cancel_by`](crate::Scratch::cancel_by), keep one to
/// [`Cancel::cancel`] with.
///
/// Nearly all runs take milliseconds and look at it once or twice. It is for what can take its size squared: fans of many thousand
/// triangles around one vertex below 180 degrees.
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

//! What calls share: reused memory, a cancellation token and a thread limit.

use crate::cancel::Cancel;
use crate::exec::limits::RunLimits;
use crate::exec::simd::{Width, WidthLimit};
use crate::exec::vertex_progress::VertexProgress;
use crate::tangents::memory::TangentMemory;

/// Reused memory, a cancellation token and a thread limit, for one call after the other.
///
/// Functions whose time grows with the mesh have a short form and a form that takes a context,
/// `generate_tangents` and [`generate_tangents_with`](crate::generate_tangents_with) for example. A new
/// context changes nothing but the memory: no token, all threads of the current rayon pool. Give each thread
/// a context of its own.
///
/// Memory grows to what the largest mesh needed. Neither the memory of earlier calls nor the number of
/// threads changes a result.
#[derive(Debug)]
pub struct Context {
    memory: TangentMemory,
    cancel: Option<Cancel>,
    max_threads: usize,
    width_limit: WidthLimit,
    progress: Option<VertexProgress>,
}

impl Default for Context {
    fn default() -> Self {
        Self {
            memory: TangentMemory::default(),
            cancel: None,
            max_threads: usize::MAX,
            width_limit: WidthLimit::default(),
            progress: None,
        }
    }
}

impl Context {
    /// A context without a token, with no limit to the threads, and without memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// This context with a clone of `cancel`: calls return [`Error::Cancelled`](crate::Error::Cancelled) once
    /// it is cancelled.
    #[must_use]
    pub fn with_cancel(mut self, cancel: &Cancel) -> Self {
        self.set_cancel(Some(cancel));
        self
    }

    /// This context with at most `count` threads per call. 1 keeps every call on its own thread and starts no
    /// pool; 0 counts as 1.
    #[must_use]
    pub fn with_max_threads(mut self, count: usize) -> Self {
        self.set_max_threads(count);
        self
    }

    /// As [`Context::with_cancel`], for a context in use; `None` removes the token.
    pub fn set_cancel(&mut self, cancel: Option<&Cancel>) {
        self.cancel = cancel.cloned();
    }

    /// As [`Context::with_max_threads`], for a context in use.
    pub fn set_max_threads(&mut self, count: usize) {
        self.max_threads = count.max(1);
    }

    /// Frees the reused memory; later calls allocate it again.
    pub fn free_memory(&mut self) {
        self.memory = TangentMemory::default();
    }

    /// A context for one thread, without memory yet; all else is as here.
    pub(crate) fn of_one_thread(&self) -> Self {
        Self {
            memory: TangentMemory::default(),
            cancel: self.cancel.clone(),
            max_threads: 1,
            width_limit: self.width_limit,
            progress: self.progress.clone(),
        }
    }

    /// The vector width never changes a result: this is for tests and benchmarks.
    pub(crate) fn set_width_limit(&mut self, limit: WidthLimit) {
        self.width_limit = limit;
    }

    /// For the command's progress bar.
    pub(crate) fn set_vertex_progress(&mut self, progress: &VertexProgress) {
        self.progress = Some(progress.clone());
    }

    /// The limits of a call.
    pub(crate) fn limits(&self) -> RunLimits<'_> {
        RunLimits {
            cancel: self.cancel.as_ref(),
            max_threads: self.max_threads,
            width: Width::widest(self.width_limit),
            progress: self.progress.as_ref(),
        }
    }

    /// The limits of a call and the memory that it reuses.
    pub(crate) fn limits_and_memory(&mut self) -> (RunLimits<'_>, &mut TangentMemory) {
        let limits = RunLimits {
            cancel: self.cancel.as_ref(),
            max_threads: self.max_threads,
            width: Width::widest(self.width_limit),
            progress: self.progress.as_ref(),
        };
        (limits, &mut self.memory)
    }
}

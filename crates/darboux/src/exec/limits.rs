//! The limits of one call: a cancellation request, a number of threads and a vector width. The counter of its
//! progress goes with them.
//!
//! A public function takes them from its [`Context`](crate::Context) once and passes the copy to every stage,
//! also to stages that run on the threads of a pool. Nothing depends on the thread that a stage runs on.

use std::ops::Range;

use crate::Error;
use crate::cancel::Cancel;
use crate::exec::simd::{Width, WidthLimit};
use crate::exec::vertex_progress::VertexProgress;

/// The fewest triangles per thread. With fewer, two threads are not always faster than one:
/// docs/notes/speed.md has the measurements.
const MIN_PER_THREAD: usize = if cfg!(small_limits) { 1 } else { 1 << 13 };

/// Elements between two cancellation checks of a long loop.
const CHECK_INTERVAL: usize = 1 << 12;

/// The limits of one call.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RunLimits<'a> {
    pub cancel: Option<&'a Cancel>,
    /// At least 1.
    pub max_threads: usize,
    pub width: Width,
    pub progress: Option<&'a VertexProgress>,
}

impl Default for RunLimits<'_> {
    fn default() -> Self {
        let width = Width::widest(WidthLimit::default());
        Self { cancel: None, max_threads: usize::MAX, width, progress: None }
    }
}

impl<'a> RunLimits<'a> {
    /// True once the call was cancelled.
    #[inline]
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(Cancel::is_cancelled)
    }

    /// Errors: the call was cancelled.
    pub fn check(&self) -> Result<(), Error> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }

    /// As [`RunLimits::check`], for element `index` of a long loop: most elements are not checked.
    #[inline]
    pub fn check_at(&self, index: usize) -> Result<(), Error> {
        if index.is_multiple_of(CHECK_INTERVAL) { self.check() } else { Ok(()) }
    }

    /// The consecutive parts of a range. The token is checked before each part; after cancellation there are
    /// no further parts.
    pub fn parts(self, range: Range<usize>) -> impl Iterator<Item = Range<usize>> + use<'a> {
        let end = range.end;
        let part = move |start: usize| start..end.min(start + CHECK_INTERVAL);
        range.step_by(CHECK_INTERVAL).map_while(move |start| (!self.is_cancelled()).then(|| part(start)))
    }

    /// How many threads share work of so many triangles: at most as many as the current thread pool has.
    pub fn thread_count(&self, triangles: usize) -> usize {
        let most = (triangles / MIN_PER_THREAD).min(self.max_threads);
        // The pool is asked last, because asking starts its threads.
        if most > 1 { pool_threads().min(most) } else { 1 }
    }

    /// How many threads share a list of jobs. Each job is worth waking a thread.
    pub fn thread_count_of_jobs(&self, jobs: usize) -> usize {
        let most = jobs.min(self.max_threads);
        if most > 1 { pool_threads().min(most) } else { 1 }
    }
}

/// The number of threads of the current thread pool; 1 where no pool can be started.
#[cfg(feature = "parallel")]
fn pool_threads() -> usize {
    if rayon::current_thread_index().is_some() || has_global_pool() {
        rayon::current_num_threads()
    } else {
        1
    }
}

#[cfg(not(feature = "parallel"))]
fn pool_threads() -> usize {
    1
}

/// Starts rayon's global pool where it has not been started. False where the system refuses threads, for
/// which rayon itself panics.
#[cfg(feature = "parallel")]
fn has_global_pool() -> bool {
    use std::error::Error;
    use std::sync::OnceLock;
    static HAS_POOL: OnceLock<bool> = OnceLock::new();
    *HAS_POOL.get_or_init(|| match rayon::ThreadPoolBuilder::new().build_global() {
        Ok(()) => true,
        // An error without a source says that there is a pool already.
        Err(error) => error.source().is_none(),
    })
}

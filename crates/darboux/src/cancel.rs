//! Stopping work from another thread.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::MeshError;

/// A request to stop, which its clones share: [`Cancel::run`] work with one, keep one to [`Cancel::cancel`] with.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// One that nobody has asked for yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Does work on this thread, in which every function of this library that takes time in a mesh's size hears the request: between
    /// stages and stretches of the mesh, and in fans that can take their size squared between their triangles.
    ///
    /// Errors: it was asked for. Functions that return a `Result` say so as well; what the others have made then is not complete, so
    /// that `work` must not use it further. Of nested runs the inner one is heard.
    pub fn run<R>(&self, work: impl FnOnce() -> R) -> Result<R, MeshError> {
        let until_the_end = Heard::set(Some(self.clone()));
        let result = work();
        drop(until_the_end);
        if self.is_cancelled() { Err(MeshError::Cancelled) } else { Ok(result) }
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

thread_local! {
    /// What this thread's work hears.
    static HEARD: RefCell<Option<Cancel>> = const { RefCell::new(None) };
}

/// Restores what was heard before, after a panic as well.
pub(crate) struct Heard(Option<Cancel>);

impl Heard {
    fn set(cancel: Option<Cancel>) -> Self {
        Self(HEARD.replace(cancel))
    }

    /// Nothing is heard: while a thread waits for others it may be given work of somebody else.
    #[cfg(feature = "parallel")]
    pub fn nothing() -> Self {
        Self::set(None)
    }
}

impl Drop for Heard {
    fn drop(&mut self) {
        HEARD.replace(self.0.take());
    }
}

/// What a call hears on all its threads.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stop(Option<Cancel>);

impl Stop {
    /// What was heard where the call began.
    pub fn heard() -> Self {
        Self(HEARD.with_borrow(Option::clone))
    }

    /// True once the call shall end.
    #[inline]
    pub fn is_asked(&self) -> bool {
        self.0.as_ref().is_some_and(Cancel::is_cancelled)
    }

    /// As an error.
    pub fn check(&self) -> Result<(), MeshError> {
        if self.is_asked() { Err(MeshError::Cancelled) } else { Ok(()) }
    }

    /// As [`Stop::check`], for every element of a long list: looks at the first of each stretch.
    #[inline]
    pub fn check_at(&self, element: usize) -> Result<(), MeshError> {
        if element.is_multiple_of(STRETCH) { self.check() } else { Ok(()) }
    }
}

/// Elements that are gone through between two looks.
const STRETCH: usize = 1 << 12;

//! A request to stop a running call from another thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// A cancellation token, shared by its clones.
///
/// Give one clone to a [`Context`](crate::Context) and keep another. After [`Cancel::cancel`] every call with
/// that context returns [`Error::Cancelled`](crate::Error::Cancelled), also a call that is already running:
/// it checks the token between its stages and inside its long loops, on every thread that it uses. A token
/// stays cancelled; make a new one for further work.
///
/// ```
/// use darboux::{Cancel, Context, Mesh, Error, TangentOptions, generate_tangents_with};
///
/// let cancel = Cancel::new();
/// let mut context = Context::new().with_cancel(&cancel);
/// // Another thread, or the handler of a button, has a clone of the token.
/// cancel.clone().cancel();
///
/// let mesh = Mesh::triangles(&[[0.0; 3]; 3], &[[0.0; 3]; 3], &[[0.0; 2]; 3], &[0u32, 1, 2])?;
/// let result = generate_tangents_with(&mesh, &TangentOptions::default(), &mut context);
/// assert_eq!(result.err(), Some(Error::Cancelled));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<State>);

#[derive(Debug, Default)]
struct State {
    is_cancelled: AtomicBool,
    /// For tests only.
    countdown: Option<Countdown>,
}

/// Counts the checks of a token, and cancels it at a given one.
#[derive(Debug)]
struct Countdown {
    checks: AtomicUsize,
    limit: usize,
}

impl Cancel {
    /// A token that is not cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// Cancels all calls that have a clone of this token. Any thread may call it.
    pub fn cancel(&self) {
        self.0.is_cancelled.store(true, Ordering::Relaxed);
    }

    /// True once the token was cancelled.
    pub fn is_cancelled(&self) -> bool {
        if let Some(countdown) = &self.0.countdown
            && countdown.checks.fetch_add(1, Ordering::Relaxed) >= countdown.limit
        {
            self.cancel();
        }
        self.0.is_cancelled.load(Ordering::Relaxed)
    }

    /// A token that is cancelled by the check after `limit` checks, for tests.
    pub(crate) fn after_checks(limit: usize) -> Self {
        let countdown = Some(Countdown { checks: AtomicUsize::new(0), limit });
        Self(Arc::new(State { countdown, ..State::default() }))
    }

    /// The number of checks of a token from [`Cancel::after_checks`]; 0 for other tokens.
    pub(crate) fn checks(&self) -> usize {
        self.0.countdown.as_ref().map_or(0, |countdown| countdown.checks.load(Ordering::Relaxed))
    }
}

//! Checks of a context's token outside this crate, and tokens that count their checks: for tests of
//! cancellation that depend on work and not on time.

use crate::{Cancel, Context, Error};

/// Errors: the context's token was cancelled.
pub fn check(context: &Context) -> Result<(), Error> {
    context.limits().check()
}

/// Whether calls with this context can be cancelled.
pub fn has_token(context: &Context) -> bool {
    context.limits().cancel.is_some()
}

/// A token that is cancelled by the check after `limit` checks.
pub fn cancel_after(limit: usize) -> Cancel {
    Cancel::after_checks(limit)
}

/// The number of checks of a token from [`cancel_after`].
pub fn check_count(cancel: &Cancel) -> usize {
    cancel.checks()
}

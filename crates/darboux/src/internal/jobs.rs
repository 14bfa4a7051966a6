//! Work of other crates, divided among the threads that a context permits.

use crate::exec::threads;
use crate::{Context, Error};

/// Calls a function with every element of a list. A thread that has finished an element takes the next one.
///
/// The token is checked before every element. Errors: the context's token was cancelled; some elements were not visited.
pub fn for_each<T: Send>(
    context: &Context,
    list: &mut [T],
    with: impl Fn(&mut T) + Sync,
) -> Result<(), Error> {
    let limits = context.limits();
    let count = limits.thread_count_of_jobs(list.len());
    threads::for_each(count, list, |element| {
        if !limits.is_cancelled() {
            with(element);
        }
    });
    limits.check()
}

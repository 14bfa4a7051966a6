//! Work of other crates, divided among the threads that a context permits.

use std::ops::Range;

use crate::exec::{blocks, threads};
use crate::{Context, Error};

/// Calls a function with every element of a list. A thread that has finished an element takes the next one.
///
/// The token is checked before every element. Errors: the context's token was cancelled; some elements were
/// not visited.
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

/// The values of a function for every element of a list. One thread computes each value.
///
/// `contexts`: one per thread, of one thread each, whose memory is reused; [`contexts`] makes them.
pub fn map_with<T: Sync, R: Send>(
    contexts: &mut [Context],
    list: &[T],
    of: impl Fn(&T, &mut Context) -> R + Sync,
) -> Vec<R> {
    let mut results: Vec<(&T, Option<R>)> = list.iter().map(|element| (element, None)).collect();
    threads::for_each_with(contexts, results.iter_mut(), |context, (element, result)| {
        *result = Some(of(element, context));
    });
    results.into_iter().filter_map(|(_, result)| result).collect()
}

/// As many contexts as threads that `context` permits for so many jobs, each of one thread, with its token
/// and its progress.
pub fn contexts(context: &Context, jobs: usize) -> Vec<Context> {
    let threads = context.limits().thread_count_of_jobs(jobs);
    (0..threads).map(|_| context.of_one_thread()).collect()
}

/// Calls `of` for consecutive ranges of the numbers below `count`, each on one thread, and `fold` with their
/// results in order. The ranges do not depend on the number of threads.
///
/// `block`: the length of all ranges but the last. Errors: the context's token was cancelled.
pub fn fold_blocks<R: Send>(
    context: &Context,
    count: usize,
    block: usize,
    of: impl Fn(Range<usize>) -> R + Sync,
    fold: impl FnMut(R),
) -> Result<(), Error> {
    blocks::fold_blocks(context.limits(), count, block, of, fold)
}

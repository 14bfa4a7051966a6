//! Work split among threads: every job has its own memory, and its own part of what is written.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::exec::limits::RunLimits;

/// Does work for a mesh on a thread of the pool, whose others are then quick to join in: all are woken only once.
#[cfg(feature = "parallel")]
pub(crate) fn on_pool<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    if threads > 1 && rayon::current_thread_index().is_none() { rayon::scope(|_| work()) } else { work() }
}

#[cfg(not(feature = "parallel"))]
pub(crate) fn on_pool<R: Send>(_threads: usize, work: impl FnOnce() -> R + Send) -> R {
    work()
}

/// Runs `job` for every worker and its part, on all threads.
pub(crate) fn run<W: Send, P: Send>(
    workers: &mut [W],
    parts: impl Iterator<Item = P>,
    job: impl Fn(&mut W, P) + Sync,
) {
    #[cfg(feature = "parallel")]
    if workers.len() > 1 {
        rayon::in_place_scope(|scope| {
            for (worker, part) in workers.iter_mut().zip(parts) {
                let job = &job;
                scope.spawn(move |_| job(worker, part));
            }
        });
        return;
    }
    for (worker, part) in workers.iter_mut().zip(parts) {
        job(worker, part);
    }
}

/// The values of `of` at 0 to `count`, in their order, found by all threads.
pub(crate) fn map<T: Send>(limits: RunLimits<'_>, count: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let threads = limits.thread_count(count);
    let mut found: Vec<Vec<T>> = (0..threads).map(|_| Vec::new()).collect();
    run(&mut found, split(0..count, threads, 1), |found, range| *found = range.map(&of).collect());
    found
        .into_iter()
        .reduce(|mut all, mut more| {
            all.append(&mut more);
            all
        })
        .unwrap_or_default()
}

/// Sets every element to the value of `of` at its place, by all threads; on one it allocates nothing.
pub(crate) fn fill<T: Send>(limits: RunLimits<'_>, slice: &mut [T], of: impl Fn(usize) -> T + Sync) {
    update(limits, slice, |at, element| *element = of(at));
}

/// Calls `with` with every element and its place, by all threads; on one it allocates nothing.
pub(crate) fn update<T: Send>(limits: RunLimits<'_>, slice: &mut [T], with: impl Fn(usize, &mut T) + Sync) {
    let threads = limits.thread_count(slice.len());
    let ranges = split(0..slice.len(), threads, 1);
    let jobs = parts(slice, 0, ranges.clone()).zip(ranges);
    run(&mut vec![(); threads], jobs, |(), (part, range)| {
        part.iter_mut().zip(range).for_each(|(element, at)| with(at, element));
    });
}

/// Whether all numbers below `count` are as wanted, by all threads; on one it allocates nothing.
pub(crate) fn all(limits: RunLimits<'_>, count: usize, is_wanted: impl Fn(usize) -> bool + Sync) -> bool {
    let threads = limits.thread_count(count);
    let found = AtomicBool::new(true);
    run(&mut vec![(); threads], split(0..count, threads, 1), |(), mut range| {
        if !range.all(&is_wanted) {
            found.store(false, Ordering::Relaxed);
        }
    });
    found.into_inner()
}

/// A range in `count` parts, of sizes that differ by one at most times `unit`.
pub(crate) fn split(
    range: Range<usize>,
    count: usize,
    unit: usize,
) -> impl Iterator<Item = Range<usize>> + Clone {
    let units = range.len().div_ceil(unit);
    (0..count).map(move |at| {
        let place = |at: usize| range.start + (units * at / count * unit).min(range.len());
        place(at)..place(at + 1)
    })
}

/// The parts of a slice whose first element is number `first`, at consecutive ranges of such numbers.
pub(crate) fn parts<T>(
    mut slice: &mut [T],
    first: usize,
    ranges: impl Iterator<Item = Range<usize>>,
) -> impl Iterator<Item = &mut [T]> {
    let mut at = first;
    ranges.map(move |range| {
        let (_, rest) = std::mem::take(&mut slice).split_at_mut(range.start - at);
        let (part, rest) = rest.split_at_mut(range.len());
        (slice, at) = (rest, range.end);
        part
    })
}

//! Work divided among threads. Every thread has its own memory, and writes its own part of the output.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

#[cfg(feature = "parallel")]
use crate::exec::helpers::call_with_helpers;
use crate::exec::limits::RunLimits;

/// Calls `job` once for every worker with its part of the work, on at most as many threads as there are
/// workers.
pub(crate) fn run<W: Send, P: Send>(
    workers: &mut [W],
    parts: impl Iterator<Item = P> + Send,
    job: impl Fn(&mut W, P) + Sync,
) {
    #[cfg(feature = "parallel")]
    if workers.len() > 1 {
        let helpers = workers.len() - 1;
        let rest = Mutex::new(workers.iter_mut().zip(parts));
        return call_with_helpers(helpers, &|| {
            while let Some((worker, part)) = rest.lock().ok().and_then(|mut rest| rest.next()) {
                job(worker, part);
            }
        });
    }
    for (worker, part) in workers.iter_mut().zip(parts) {
        job(worker, part);
    }
}

/// Calls a function with every element of a list. A thread that has finished an element takes the next one.
///
/// `threads`: the number of threads, at least 1.
pub(crate) fn for_each<T: Send>(threads: usize, list: &mut [T], with: impl Fn(&mut T) + Sync) {
    for_each_with(&mut vec![(); threads], list.iter_mut(), |(), element| with(element));
}

/// As [`for_each`], with the elements of an iterator, on as many threads as there are workers. Each thread
/// uses a worker of its own.
pub(crate) fn for_each_with<W: Send, T>(
    workers: &mut [W],
    elements: impl Iterator<Item = T> + Send,
    with: impl Fn(&mut W, T) + Sync,
) {
    if let [worker] = workers {
        return elements.for_each(|element| with(worker, element));
    }
    let rest = Mutex::new(elements);
    let parts = std::iter::repeat_n((), workers.len());
    run(workers, parts, |worker, ()| {
        while let Ok(Some(element)) = rest.lock().map(|mut rest| rest.next()) {
            with(worker, element);
        }
    });
}

/// The values of a function for all numbers below `count`, computed on all threads. There are fewer after
/// cancellation.
pub(crate) fn map<T: Send>(limits: RunLimits<'_>, count: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let threads = limits.thread_count(count);
    let mut lists: Vec<Vec<T>> = (0..threads).map(|_| Vec::new()).collect();
    run(&mut lists, split_range(0..count, threads, 1), |list, range| {
        list.reserve_exact(range.len());
        limits.parts(range).for_each(|part| list.extend(part.map(&of)));
    });
    lists
        .into_iter()
        .reduce(|mut all, mut more| {
            all.append(&mut more);
            all
        })
        .unwrap_or_default()
}

/// Sets every element to the value of a function for its index, on all threads. A single thread allocates
/// nothing. After cancellation the remaining elements stay as they are.
pub(crate) fn fill<T: Send>(limits: RunLimits<'_>, slice: &mut [T], of: impl Fn(usize) -> T + Sync) {
    update(limits, slice, |at, element| *element = of(at));
}

/// Calls a function with the index of every element and the element, on all threads. A single thread
/// allocates nothing. After cancellation the remaining elements are skipped.
pub(crate) fn update<T: Send>(limits: RunLimits<'_>, slice: &mut [T], with: impl Fn(usize, &mut T) + Sync) {
    let threads = limits.thread_count(slice.len());
    let ranges = split_range(0..slice.len(), threads, 1);
    let jobs = split_slice(slice, 0, ranges.clone()).zip(ranges);
    run(&mut vec![(); threads], jobs, |(), (part, range)| {
        let first = range.start;
        for elements in limits.parts(range) {
            let of_elements = &mut part[elements.start - first..elements.end - first];
            of_elements.iter_mut().zip(elements).for_each(|(element, at)| with(at, element));
        }
    });
}

/// True when a predicate holds for all numbers below `count`, tested on all threads. A single thread
/// allocates nothing. The result is unspecified after cancellation.
pub(crate) fn all(limits: RunLimits<'_>, count: usize, predicate: impl Fn(usize) -> bool + Sync) -> bool {
    let threads = limits.thread_count(count);
    let holds = AtomicBool::new(true);
    run(&mut vec![(); threads], split_range(0..count, threads, 1), |(), range| {
        if !limits.parts(range).all(|mut part| part.all(&predicate)) {
            holds.store(false, Ordering::Relaxed);
        }
    });
    holds.into_inner()
}

/// Splits a range into `count` consecutive ranges of nearly equal length. All but the last length are
/// multiples of `unit`.
pub(crate) fn split_range(
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

/// Splits a slice at consecutive ranges of element numbers. `first`: the number of the slice's first element.
pub(crate) fn split_slice<T>(
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

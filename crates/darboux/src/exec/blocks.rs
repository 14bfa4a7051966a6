//! Long lists in blocks: few results are in memory at a time, and the result does not depend on the number of
//! threads.

use std::ops::Range;

use crate::Error;
use crate::exec::limits::RunLimits;
use crate::exec::threads;

/// Blocks per thread whose results wait to be folded. A thread that has finished its block takes the next one
/// of these.
const BLOCKS_AT_ONCE: usize = 8;

/// Calls `of` for consecutive ranges of the numbers below `count` on all threads, and `fold` with their
/// results in order.
///
/// `block`: the length of all ranges but the last. Errors: the call was cancelled; `of` may have returned
/// early then.
pub(crate) fn fold_blocks<R: Send>(
    limits: RunLimits<'_>,
    count: usize,
    block: usize,
    of: impl Fn(Range<usize>) -> R + Sync,
    mut fold: impl FnMut(R),
) -> Result<(), Error> {
    let threads = limits.thread_count_of_jobs(count.div_ceil(block));
    let mut starts = (0..count).step_by(block);
    loop {
        limits.check()?;
        let mut results: Vec<(usize, Option<R>)> =
            starts.by_ref().take(BLOCKS_AT_ONCE * threads).map(|start| (start, None)).collect();
        if results.is_empty() {
            return Ok(());
        }
        threads::for_each(threads, &mut results, |(start, result)| {
            if !limits.is_cancelled() {
                *result = Some(of(*start..count.min(*start + block)));
            }
        });
        results.into_iter().filter_map(|(_, result)| result).for_each(&mut fold);
    }
}

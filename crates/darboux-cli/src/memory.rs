//! The memory that this process may use, and how its jobs share it.
//!
//! What is in use at the start is subtracted once, so that a file is refused or not whatever else is
//! processed at the same time.

mod estimate;

use std::collections::BTreeMap;
#[cfg(feature = "bake")]
use std::fs;
use std::sync::{Condvar, Mutex, MutexGuard, OnceLock, PoisonError};

use darboux_io::memory_of_process;

#[cfg(feature = "bake")]
pub use estimate::of_model;
pub use estimate::{of_file, of_stream};

/// The bytes that the process may still use, by its limits; none without a limit. Measured at the first call.
pub fn of_process() -> Option<u64> {
    static BYTES: OnceLock<Option<u64>> = OnceLock::new();
    *BYTES.get_or_init(memory_of_process)
}

/// The bytes that the process may use and that the system can give without swapping; none where it does not
/// say. `share`: the part of it that a job may use, if it works beside others.
#[cfg(feature = "bake")]
pub fn available(share: Option<u64>) -> Option<u64> {
    let of_system = || {
        let info = fs::read_to_string("/proc/meminfo").ok()?;
        let line = info.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
        let kibibytes: u64 = line.trim().strip_suffix(" kB")?.trim().parse().ok()?;
        Some(kibibytes << 10)
    };
    [of_system(), of_process(), share].into_iter().flatten().min()
}

/// Lets jobs begin while the estimates of those at work fit into the memory of the process; a larger one
/// works alone.
///
/// A job that came later begins before one that waits only where both fit together, beside all others that
/// came later. So a job waits for those that came before it, and for no other, and small ones still fill what
/// a large one leaves free.
pub struct JobMemory {
    total: Option<u64>,
    jobs: Mutex<Jobs>,
    changed: Condvar,
}

/// The memory of a job until it is dropped.
pub struct Share<'a> {
    of: &'a JobMemory,
    number: u64,
}

/// The jobs that wait or are at work, by the numbers in which they came, each with its bytes.
#[derive(Default)]
struct Jobs {
    next_number: u64,
    waiting: BTreeMap<u64, u64>,
    at_work: BTreeMap<u64, u64>,
}

impl Jobs {
    /// Whether a job that waits may begin.
    fn may_begin(&self, number: u64, total: u64) -> bool {
        let bytes = self.waiting[&number];
        let fits_beside = |first: u64, more: u64| {
            let others = self.at_work.range(first..).map(|(_, bytes)| *bytes);
            others.fold(bytes, u64::saturating_add).saturating_add(more) <= total
        };
        fits_beside(0, 0) && self.waiting.range(..number).all(|(&first, &waits)| fits_beside(first, waits))
    }
}

impl JobMemory {
    /// The memory of this process.
    pub fn of_process() -> Self {
        Self::new(of_process())
    }

    /// All memory that the process may use and that the system can give.
    #[cfg(feature = "bake")]
    pub fn available() -> Self {
        Self::new(available(None))
    }

    fn new(total: Option<u64>) -> Self {
        Self { total, jobs: Mutex::default(), changed: Condvar::new() }
    }

    /// Waits until there is as much memory as `estimate` says. It is not asked where there is no limit.
    pub fn wait_for(&self, estimate: impl FnOnce() -> u64) -> Share<'_> {
        let Some(total) = self.total else { return Share { of: self, number: 0 } };
        let bytes = estimate().min(total);
        let mut jobs = self.jobs();
        let number = jobs.next_number;
        jobs.next_number += 1;
        jobs.waiting.insert(number, bytes);
        let waits = |jobs: &mut Jobs| !jobs.may_begin(number, total);
        let mut jobs = self.changed.wait_while(jobs, waits).unwrap_or_else(PoisonError::into_inner);
        jobs.waiting.remove(&number);
        jobs.at_work.insert(number, bytes);
        // Files that would have been in its way may begin.
        self.changed.notify_all();
        Share { of: self, number }
    }

    fn jobs(&self) -> MutexGuard<'_, Jobs> {
        self.jobs.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(feature = "bake")]
impl Share<'_> {
    /// The bytes; none where there is no limit.
    pub fn limit(&self) -> Option<u64> {
        self.of.jobs().at_work.get(&self.number).copied()
    }

    /// Whether this is all memory.
    pub fn is_whole(&self) -> bool {
        self.limit() == self.of.total
    }
}

impl Drop for Share<'_> {
    fn drop(&mut self) {
        self.of.jobs().at_work.remove(&self.number);
        self.of.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};
    use std::sync::mpsc;
    use std::thread;
    use std::time::Duration;

    use super::*;

    #[test]
    fn jobs_wait_for_memory_and_a_large_one_works_alone() {
        let memory = JobMemory::new(Some(48));
        let (at_work, most) = (AtomicU64::new(0), AtomicU64::new(0));
        thread::scope(|scope| {
            for size in [16, 16, 16, 16, u64::MAX, 16, 16, 40] {
                let (memory, at_work, most) = (&memory, &at_work, &most);
                scope.spawn(move || {
                    let share = memory.wait_for(|| size);
                    let bytes = share.limit().expect("there is a limit");
                    let now = at_work.fetch_add(bytes, Ordering::SeqCst) + bytes;
                    most.fetch_max(now, Ordering::SeqCst);
                    at_work.fetch_sub(bytes, Ordering::SeqCst);
                });
            }
        });
        assert_eq!(most.load(Ordering::SeqCst), 48);
        assert!(memory.jobs().at_work.is_empty() && memory.jobs().waiting.is_empty());
    }

    /// How long a test waits for a job that must not begin.
    const A_MOMENT: Duration = Duration::from_millis(50);

    /// Starts a job on a thread of its own, which says when it begins and ends once it is told to.
    fn start<'s>(
        scope: &'s thread::Scope<'s, '_>,
        memory: &'s JobMemory,
        bytes: u64,
    ) -> (mpsc::Receiver<()>, mpsc::Sender<()>) {
        let ((begun, has_begun), (end, may_end)) = (mpsc::channel(), mpsc::channel::<()>());
        scope.spawn(move || {
            let share = memory.wait_for(|| bytes);
            begun.send(()).expect("the test goes on");
            // The sender is dropped.
            let _ended = may_end.recv();
            drop(share);
        });
        (has_begun, end)
    }

    #[test]
    fn no_job_that_came_later_keeps_a_large_one_waiting() {
        let memory = &JobMemory::new(Some(10));
        thread::scope(|scope| {
            let begins = |job: &mpsc::Receiver<()>| job.recv_timeout(Duration::from_secs(60)).is_ok();
            let waits = |job: &mpsc::Receiver<()>| job.recv_timeout(A_MOMENT).is_err();
            let (first, end_of_first) = start(scope, memory, 6);
            assert!(begins(&first));
            let (large, end_of_large) = start(scope, memory, 7);
            assert!(waits(&large));
            // Fits beside both.
            let (small, end_of_small) = start(scope, memory, 3);
            assert!(begins(&small));
            // Fits beside those at work, and would be in the way of the large one.
            let (other, end_of_other) = start(scope, memory, 1);
            assert!(waits(&other));
            drop(end_of_first);
            assert!(begins(&large));
            drop(end_of_small);
            assert!(begins(&other));
            drop((end_of_large, end_of_other));
        });
    }

    /// A job that needs all memory, in a stream of small ones that never leaves the memory free.
    #[test]
    fn a_stream_of_small_jobs_ends_for_a_large_one() {
        let memory = JobMemory::new(Some(48));
        let large_has_begun = AtomicU64::new(0);
        thread::scope(|scope| {
            let mut shares = vec![memory.wait_for(|| 1)];
            scope.spawn(|| {
                let _all = memory.wait_for(|| u64::MAX);
                large_has_begun.store(1, Ordering::SeqCst);
            });
            while memory.jobs().waiting.is_empty() {
                thread::yield_now();
            }
            let (small, end_of_small) = start(scope, &memory, 1);
            assert!(small.recv_timeout(A_MOMENT).is_err());
            shares.clear();
            assert!(small.recv_timeout(Duration::from_secs(60)).is_ok());
            assert_eq!(large_has_begun.load(Ordering::SeqCst), 1);
            drop(end_of_small);
        });
    }
}

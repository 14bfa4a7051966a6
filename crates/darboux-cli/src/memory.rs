//! The memory that this process may use, and how its jobs share it.
//!
//! What is in use at the start is subtracted once, so that a file is refused or not whatever else is
//! processed at the same time.

mod estimate;

#[cfg(feature = "bake")]
use std::fs;
use std::sync::{Condvar, Mutex, OnceLock, PoisonError};

use darboux_io::memory_of_process;

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
pub struct JobMemory {
    total: Option<u64>,
    used: Mutex<u64>,
    freed: Condvar,
}

/// The memory of a job until it is dropped.
pub struct Share<'a> {
    of: &'a JobMemory,
    bytes: u64,
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
        Self { total, used: Mutex::new(0), freed: Condvar::new() }
    }

    /// Waits until there is as much memory as `estimate` says. It is not asked where there is no limit.
    pub fn wait_for(&self, estimate: impl FnOnce() -> u64) -> Share<'_> {
        let Some(total) = self.total else { return Share { of: self, bytes: 0 } };
        let bytes = estimate().min(total);
        let used = self.used.lock().unwrap_or_else(PoisonError::into_inner);
        let is_full = |used: &mut u64| *used > 0 && used.saturating_add(bytes) > total;
        *self.freed.wait_while(used, is_full).unwrap_or_else(PoisonError::into_inner) += bytes;
        Share { of: self, bytes }
    }
}

#[cfg(feature = "bake")]
impl Share<'_> {
    /// The bytes; none where there is no limit.
    pub fn limit(&self) -> Option<u64> {
        self.of.total.map(|_| self.bytes)
    }

    /// Whether this is all memory.
    pub fn is_whole(&self) -> bool {
        self.of.total.is_none_or(|total| self.bytes == total)
    }
}

impl Drop for Share<'_> {
    fn drop(&mut self) {
        *self.of.used.lock().unwrap_or_else(PoisonError::into_inner) -= self.bytes;
        self.of.freed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};
    use std::thread;

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
                    let now = at_work.fetch_add(share.bytes, Ordering::SeqCst) + share.bytes;
                    most.fetch_max(now, Ordering::SeqCst);
                    at_work.fetch_sub(share.bytes, Ordering::SeqCst);
                });
            }
        });
        assert_eq!(most.load(Ordering::SeqCst), 48);
        assert_eq!(*memory.used.lock().unwrap(), 0);
    }
}

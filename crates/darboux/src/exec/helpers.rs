//! Helpers: threads of the pool that take a share of a call's work if they come in time.
//!
//! The calling thread begins at once and never waits for a thread that has not begun: waking one takes tens
//! of microseconds, in which a thread computes thousands of triangles, and a pool may be busy with other work
//! for much longer. Scopes of rayon wait for all of their tasks, also for those that no thread has begun.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Mutex, PoisonError, RwLock};

/// Calls `work` on this thread and meanwhile on up to `helpers` threads of the current pool. Returns when all
/// calls that began have ended.
///
/// `work`: takes parts from a common list until none is left, so that one call alone does everything.
///
/// Panics: with the payload of a helper's panic.
pub(crate) fn call_with_helpers(helpers: usize, work: &(dyn Fn() + Sync)) {
    let lent = Arc::new(LentWork::new(work));
    spawn(&lent, helpers);
    let taking_back = TakeBack(&lent);
    work();
    drop(taking_back);
    let panic = lent.panic.lock().unwrap_or_else(PoisonError::into_inner).take();
    if let Some(payload) = panic {
        resume_unwind(payload);
    }
}

/// Wakes one thread, which wakes the others.
fn spawn(lent: &Arc<LentWork>, helpers: usize) {
    if helpers > 0 {
        let lent = Arc::clone(lent);
        rayon::spawn(move || lent.help(helpers - 1));
    }
}

type Work = dyn Fn() + Sync;

/// Work that other threads may call until it is taken back.
struct LentWork {
    /// Helpers hold a read lock while they call the work. None: it has been taken back.
    work: RwLock<Option<&'static Work>>,
    /// The payload of a helper's panic.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

impl LentWork {
    #[expect(unsafe_code, reason = "tasks of a pool cannot borrow from a caller that does not wait for them")]
    fn new<'a>(work: &'a (dyn Fn() + Sync + 'a)) -> Self {
        // SAFETY: `call_with_helpers` neither returns nor unwinds before `TakeBack` has removed the
        // reference, under a lock that no helper holds any more. So nothing has the reference when
        // its real lifetime ends.
        let work = unsafe { std::mem::transmute::<&'a (dyn Fn() + Sync + 'a), &'static Work>(work) };
        Self { work: RwLock::new(Some(work)), panic: Mutex::new(None) }
    }

    /// Calls the work, unless it has been taken back. `further`: how many more threads are wanted.
    fn help(self: &Arc<Self>, further: usize) {
        let Ok(lock) = self.work.try_read() else { return };
        let Some(work) = *lock else { return };
        spawn(self, further / 2);
        spawn(self, further - further / 2);
        if let Err(payload) = catch_unwind(AssertUnwindSafe(work)) {
            *self.panic.lock().unwrap_or_else(PoisonError::into_inner) = Some(payload);
        }
    }
}

/// Takes lent work back when it is dropped: waits for the helpers that have begun.
struct TakeBack<'a>(&'a LentWork);

/// How often the lock is tried before other threads get this thread's core: the last parts end within
/// microseconds of each other.
const SPINS: usize = 1 << 10;

impl Drop for TakeBack<'_> {
    fn drop(&mut self) {
        let mut tries = 0;
        loop {
            if let Ok(mut work) = self.0.work.try_write() {
                *work = None;
                return;
            }
            tries += 1;
            if tries < SPINS { std::hint::spin_loop() } else { std::thread::yield_now() }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::sync::{Barrier, mpsc};

    fn pool(threads: usize) -> rayon::ThreadPool {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool")
    }

    #[test]
    fn every_part_is_done_once_before_the_call_returns() {
        let pool = pool(3);
        for call in 0..if cfg!(miri) { 20 } else { 3_000 } {
            let done: Vec<AtomicUsize> = (0..call % 40).map(|_| AtomicUsize::new(0)).collect();
            let next = AtomicUsize::new(0);
            let work = || {
                while let Some(part) = done.get(next.fetch_add(1, Ordering::Relaxed)) {
                    part.fetch_add(1, Ordering::Relaxed);
                }
            };
            pool.install(|| call_with_helpers(call % 5, &work));
            assert!(done.iter().all(|part| part.load(Ordering::Relaxed) == 1));
        }
    }

    #[test]
    fn a_busy_pool_does_not_delay_the_caller() {
        let (pool, both_began) = (pool(2), Arc::new(Barrier::new(2)));
        let (end, is_ended) = mpsc::channel::<()>();
        let other_began = Arc::clone(&both_began);
        let calls = AtomicUsize::new(0);
        pool.install(|| {
            rayon::spawn(move || {
                other_began.wait();
                _ = is_ended.recv();
            });
            both_began.wait();
            call_with_helpers(1, &|| _ = calls.fetch_add(1, Ordering::Relaxed));
        });
        assert_eq!(calls.into_inner(), 1);
        drop(end);
    }

    #[test]
    fn a_panic_reaches_the_caller() {
        let both_began = Barrier::new(2);
        let work = || {
            assert!(!both_began.wait().is_leader(), "a panic of one of the two");
        };
        let call = || pool(2).install(|| call_with_helpers(1, &work));
        let payload = catch_unwind(AssertUnwindSafe(call)).expect_err("a panic");
        assert!(payload.downcast_ref::<&str>().is_some_and(|text| text.contains("of one of the two")));
    }

    #[test]
    fn a_caller_s_panic_waits_for_helpers() {
        let (both_began, helper_ended) = (Barrier::new(2), AtomicUsize::new(0));
        let caller = std::thread::current().id();
        let work = || {
            both_began.wait();
            assert_ne!(std::thread::current().id(), caller, "the caller's panic");
            std::thread::sleep(std::time::Duration::from_millis(20));
            helper_ended.store(1, Ordering::Relaxed);
        };
        let call = || call_with_helpers(1, &work);
        assert!(catch_unwind(AssertUnwindSafe(call)).is_err());
        assert_eq!(helper_ended.into_inner(), 1);
    }
}

//! What calls keep from one to the next: memory, and threads.

use std::thread::{Builder, JoinHandle, available_parallelism};

use darboux::{Context, MeshError};
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::pointers::{self, Output};
use crate::status::{Error, call, darboux_status};

/// Memory that calls keep from one to the next, so that many meshes allocate as one, and threads for large meshes.
///
/// One thread at a time may use it.
#[derive(Default)]
pub struct darboux_scratch {
    memory: Memory,
    threads: Option<Threads>,
}

#[derive(Default)]
pub(crate) struct Memory {
    pub context: Context,
    /// Results on their way to arrays that the core cannot write.
    tangents: Vec<[f32; 4]>,
}

/// A pool whose threads have ended when it is gone: a program may close the library then.
struct Threads {
    pool: Option<ThreadPool>,
    threads: Vec<JoinHandle<()>>,
}

/// Meshes of fewer corners are not worth waking a thread.
const FEWEST_CORNERS: usize = 3 << 14;

/// A number that a caller made up must not exhaust the machine.
const MOST_THREADS: usize = 1024;

impl Threads {
    fn start(count: usize) -> Result<Self, Error> {
        let mut threads = Vec::new();
        let start = |thread: rayon::ThreadBuilder| {
            let name = format!("darboux {}", thread.index());
            threads.push(Builder::new().name(name).spawn(|| thread.run())?);
            Ok(())
        };
        let pool = ThreadPoolBuilder::new().num_threads(count).spawn_handler(start).build();
        let failed = |error| {
            let message = format!("{count} threads cannot be started: {error}; ask for fewer");
            Error::new(darboux_status::Threads, message)
        };
        Ok(Self { pool: Some(pool.map_err(failed)?), threads })
    }

    fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

impl Drop for Threads {
    fn drop(&mut self) {
        // Tells the threads to end.
        self.pool = None;
        for thread in self.threads.drain(..) {
            // What a thread panicked with was passed on to the call that it worked for.
            let _ = thread.join();
        }
    }
}

/// Does a call's work on the threads of its scratch, if so many corners are worth it; else on the calling thread.
pub(crate) fn run<'a, R: Send>(
    scratch: Option<&darboux_scratch>,
    corners: usize,
    context: &'a mut Context,
    work: impl FnOnce(&'a mut Context) -> R + Send,
) -> R {
    match scratch.and_then(|scratch| scratch.threads.as_ref()) {
        Some(threads) if corners >= FEWEST_CORNERS => {
            context.set_max_threads(usize::MAX);
            threads.install(|| work(context))
        }
        _ => {
            context.set_max_threads(1);
            work(context)
        }
    }
}

/// As [`run`], with the scratch's memory, into a caller's array.
pub(crate) fn fill<R: Send>(
    scratch: Option<&mut darboux_scratch>,
    out: Output<[f32; 4]>,
    work: impl FnOnce(&mut Context, &mut [[f32; 4]]) -> Result<R, MeshError> + Send,
) -> Result<R, Error> {
    let filled = lend(scratch, |kept, Memory { context, tangents }| {
        out.fill(tangents, |corners| {
            run(Some(kept), corners.len(), context, |context| work(context, corners))
        })
    });
    Ok(filled?)
}

/// Has `work` use a scratch and its memory, or ones that are gone afterwards.
pub(crate) fn lend<R>(
    scratch: Option<&mut darboux_scratch>,
    work: impl FnOnce(&darboux_scratch, &mut Memory) -> R,
) -> R {
    let mut local = darboux_scratch::default();
    let kept = scratch.unwrap_or(&mut local);
    // Out of the caller's hands, so that a defect cannot leave it half-written.
    let mut memory = std::mem::take(&mut kept.memory);
    let result = work(kept, &mut memory);
    kept.memory = memory;
    result
}

/// Makes an empty scratch, which grows to what the largest mesh needs.
///
/// `threads`: how many threads large meshes get, the same bits from any number: 1 for the calling thread alone; more are started now,
/// and wait while there is nothing to do; 0 for as many as the machine has. `scratch`: receives it, for darboux_scratch_free.
/// Errors: null; threads that cannot be started.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_scratch_create(
    threads: usize,
    scratch: *mut *mut darboux_scratch,
) -> darboux_status {
    let make = || {
        let count = match threads {
            0 => available_parallelism().map_or(1, |count| count.get().min(MOST_THREADS)),
            1..=MOST_THREADS => threads,
            _ => {
                let message = format!("{threads} threads are too many: the limit is {MOST_THREADS}");
                return Err(Error::new(darboux_status::Threads, message));
            }
        };
        let threads = if count > 1 { Some(Threads::start(count)?) } else { None };
        Ok(darboux_scratch { threads, ..darboux_scratch::default() })
    };
    // SAFETY: `scratch` is null or may be written.
    call(|| unsafe { pointers::hand_out("scratch", scratch, make) })
}

/// Frees a scratch, when its threads have ended; nothing where it is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_scratch_free(scratch: *mut darboux_scratch) {
    // SAFETY: `scratch` is null or from `darboux_scratch_create`, and no longer used.
    unsafe { pointers::take_back(scratch) }
}

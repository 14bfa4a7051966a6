//! `darboux_context`: reused memory, a thread pool for large meshes, and a cancellation flag.
//!
//! A call takes the memory out of the context and puts it back when it returns. A call that panics therefore
//! leaves an empty context, and a concurrent call with the same context allocates its own memory.

use std::sync::{Mutex, PoisonError};
use std::thread::{Builder, JoinHandle, available_parallelism};

use darboux::{Cancel, Context};
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::pointers::{self, Output, held};
use crate::status::{Error, call, darboux_status};

/// Reused memory, threads for large meshes, and a cancellation flag.
///
/// Calls reuse the memory of the context, and allocate only where a mesh needs more than all meshes before
/// it. One thread at a time may use a context, except for darboux_context_cancel, which any thread may call.
#[derive(Default)]
pub struct darboux_context {
    memory: Mutex<Memory>,
    pool: Option<Pool>,
    cancel: Mutex<Cancel>,
}

#[derive(Default)]
pub(crate) struct Memory {
    pub context: Context,
    /// Temporary results for output arrays that are not slices.
    tangents: Vec<[f32; 4]>,
}

/// A thread pool. Dropping it waits until its threads have ended, because the program may unload the library
/// afterwards.
struct Pool {
    pool: Option<ThreadPool>,
    threads: Vec<JoinHandle<()>>,
}

/// The smallest number of corners for which threads are used. Waking a thread costs more than smaller meshes
/// save.
const MIN_CORNERS: usize = 3 << 14;

/// The largest number of threads: a limit against typing errors, which could exhaust the machine.
const MAX_THREADS: usize = 1024;

impl Pool {
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

impl Drop for Pool {
    fn drop(&mut self) {
        // Tells the threads to end.
        self.pool = None;
        for thread in self.threads.drain(..) {
            // The panic of a thread has been passed on to the call that the thread worked for.
            let _ = thread.join();
        }
    }
}

/// Runs `work` with the memory, the threads and the cancellation flag of a context.
///
/// Without a context, and below [`MIN_CORNERS`] corners, `work` runs on the calling thread.
pub(crate) fn run<R: Send>(
    context: Option<&darboux_context>,
    corners: usize,
    work: impl FnOnce(&mut Memory) -> R + Send,
) -> R {
    let Some(shared) = context else {
        let mut memory = Memory::default();
        memory.context.set_max_threads(1);
        return work(&mut memory);
    };
    let mut memory = std::mem::take(&mut *shared.memory.lock().unwrap_or_else(PoisonError::into_inner));
    memory.context.set_cancel(Some(&shared.cancel()));
    let result = match &shared.pool {
        Some(pool) if corners >= MIN_CORNERS => {
            memory.context.set_max_threads(usize::MAX);
            pool.install(|| work(&mut memory))
        }
        _ => {
            memory.context.set_max_threads(1);
            work(&mut memory)
        }
    };
    *shared.memory.lock().unwrap_or_else(PoisonError::into_inner) = memory;
    result
}

/// As [`run`], with an output array of one tangent per corner.
pub(crate) fn fill<R: Send>(
    context: Option<&darboux_context>,
    out: Output<[f32; 4]>,
    work: impl FnOnce(&mut Context, &mut [[f32; 4]]) -> Result<R, darboux::Error> + Send,
) -> Result<R, Error> {
    let corners = out.len();
    let filled = run(context, corners, |Memory { context, tangents }| {
        out.fill(tangents, |corners| work(context, corners))
    });
    Ok(filled?)
}

impl darboux_context {
    fn cancel(&self) -> Cancel {
        self.cancel.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Creates an empty context. Its memory grows to the requirement of the largest mesh.
///
/// `threads`: the number of threads for large meshes; the results have equal bits for any number. 1: the
/// calling thread only. 2 to 1024: the threads start now and sleep between calls. 0: the number of the
/// machine's hardware threads. `context`: receives the context; free it with darboux_context_free. Errors: a
/// null pointer; threads cannot be started.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_context_create(
    threads: usize,
    context: *mut *mut darboux_context,
) -> darboux_status {
    let make = || {
        let count = match threads {
            0 => available_parallelism().map_or(1, |count| count.get().min(MAX_THREADS)),
            1..=MAX_THREADS => threads,
            _ => {
                let message = format!("{threads} threads are too many: the limit is {MAX_THREADS}");
                return Err(Error::new(darboux_status::Threads, message));
            }
        };
        let pool = if count > 1 { Some(Pool::start(count)?) } else { None };
        Ok(darboux_context { pool, ..darboux_context::default() })
    };
    // SAFETY: `context` is null or writable.
    call(|| unsafe { pointers::hand_out("context", context, make) })
}

/// Cancels the running call of a context and all later ones until darboux_context_resume. Any thread may call
/// it.
///
/// Cancelled calls return DARBOUX_STATUS_CANCELLED, and their output arrays are unspecified. Errors: a null
/// pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_context_cancel(context: *const darboux_context) -> darboux_status {
    call(|| {
        // SAFETY: `context` is null or from `darboux_context_create`, and not freed.
        unsafe { held("context", context) }?.cancel().cancel();
        Ok(())
    })
}

/// Clears the cancellation flag of a context, so that later calls run. Errors: a null pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_context_resume(context: *const darboux_context) -> darboux_status {
    call(|| {
        // SAFETY: `context` is null or from `darboux_context_create`, and not freed.
        let context = unsafe { held("context", context) }?;
        *context.cancel.lock().unwrap_or_else(PoisonError::into_inner) = Cancel::new();
        Ok(())
    })
}

/// Frees a context after its threads have ended. `context`: from darboux_context_create; may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_context_free(context: *mut darboux_context) {
    // SAFETY: `context` is null or from `darboux_context_create`, and no longer used.
    unsafe { pointers::take_back(context) }
}

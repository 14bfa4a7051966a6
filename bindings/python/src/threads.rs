//! Runs work without the GIL, on the requested number of threads.
//!
//! Each process has thread pools of its own: a forked child has none of its parent's threads, so work for the
//! parent's pool would wait forever.

use std::collections::HashMap;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use darboux::{Cancel, Context};
use pyo3::exceptions::{PyRuntimeError, PyTypeError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::mesh::value_error;
use crate::numbers::Threads;

/// The pools of a process, by number of threads; 0 stands for the number of hardware threads.
struct Pools {
    process: u32,
    by_threads: HashMap<usize, Arc<ThreadPool>>,
}

static POOLS: Mutex<Option<Pools>> = Mutex::new(None);

/// Meshes with fewer corners run on the calling thread, because waking a pool costs more than it gains.
const MIN_CORNERS: usize = 3 << 14;

/// Runs `work` without the GIL on this number of threads.
pub fn limited<R: Send>(
    py: Python<'_>,
    Threads(threads): Threads,
    work: impl FnOnce() -> R + Send,
) -> PyResult<R> {
    let pool = pool(threads)?;
    Ok(py.detach(|| pool.install(work)))
}

/// The pool of this process with this number of threads; 0 stands for the number of hardware threads. The GIL
/// is held, so no fork can happen while the lock is held.
fn pool(threads: usize) -> PyResult<Arc<ThreadPool>> {
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if pools.as_ref().is_some_and(|pools| pools.process != process) {
        // Dropping the parent's pools would wait for threads that do not exist in this process.
        std::mem::forget(pools.take());
    }
    let pools = pools.get_or_insert_with(|| Pools { process, by_threads: HashMap::new() });
    if let Some(pool) = pools.by_threads.get(&threads) {
        return Ok(pool.clone());
    }
    let made =
        ThreadPoolBuilder::new().num_threads(threads).thread_name(|at| format!("darboux {at}")).build();
    let made = made.map_err(|error| {
        PyRuntimeError::new_err(format!("{threads} threads cannot be started: {error}; ask for fewer"))
    })?;
    let pool = Arc::new(made);
    pools.by_threads.insert(threads, pool.clone());
    Ok(pool)
}

/// Runs `work` on this number of corners without the GIL, with `context`. Ctrl-C cancels it. `is_slow`: the
/// work may take quadratic time.
pub fn cancellable<R: Send>(
    py: Python<'_>,
    threads: Option<Threads>,
    (corners, is_slow): (usize, bool),
    context: &mut Context,
    work: impl FnOnce(&mut Context) -> Result<R, darboux::Error> + Send,
) -> PyResult<R> {
    if corners < MIN_CORNERS && !is_slow {
        context.set_cancel(None);
        context.set_max_threads(1);
        return py.detach(|| work(context)).map_err(value_error);
    }
    let cancel = Cancel::new();
    context.set_cancel(Some(&cancel));
    context.set_max_threads(usize::MAX);
    let work = |_: &Sender<()>| work(context);
    run_interruptibly(py, Threads::or_all(threads), work, |()| Ok(()), || cancel.cancel())?
        .map_err(value_error)
}

/// Refuses a receiver of progress that cannot be called.
pub fn check_progress(progress: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
    match progress {
        Some(progress) if !progress.is_callable() => {
            let kind = progress.get_type().name()?;
            Err(PyTypeError::new_err(format!("progress must be callable, not {kind}")))
        }
        _ => Ok(()),
    }
}

/// The interval between checks for Ctrl-C while another thread works.
const CHECK_INTERVAL: Duration = Duration::from_millis(50);

/// Runs `work` on a pool without the GIL. This thread waits, passes messages of the work to `receive`, and
/// checks for Ctrl-C.
///
/// After Ctrl-C or an error of `receive`, it calls `stop` and waits for the work to end; the result is
/// dropped. `threads`: as for [`pool`].
pub fn run_interruptibly<M: Send, R: Send>(
    py: Python<'_>,
    threads: usize,
    work: impl FnOnce(&Sender<M>) -> R + Send,
    mut receive: impl FnMut(M) -> PyResult<()>,
    stop: impl Fn(),
) -> PyResult<R> {
    let (sender, mut receiver) = channel();
    let mut done = None;
    let mut outcome = Ok(());
    let pool = pool(threads)?;
    let result = &mut done;
    pool.in_place_scope(|scope| {
        scope.spawn(move |_| *result = Some(work(&sender)));
        loop {
            let message;
            (receiver, message) = py.detach(move || {
                let message = receiver.recv_timeout(CHECK_INTERVAL);
                (receiver, message)
            });
            let is_done = matches!(message, Err(RecvTimeoutError::Disconnected));
            if outcome.is_ok() {
                outcome = message.map_or_else(|_| py.check_signals(), &mut receive);
                if outcome.is_err() {
                    stop();
                }
            }
            if is_done {
                break;
            }
        }
    });
    outcome?;
    done.ok_or_else(|| PyRuntimeError::new_err("the work was abandoned; this is a defect of darboux"))
}

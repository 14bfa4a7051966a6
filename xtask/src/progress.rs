//! Progress of long tasks: a line when a step starts, a line every few seconds while it runs, and a line with
//! its time.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// The longest silence while a step runs.
const INTERVAL: Duration = Duration::from_secs(5);

/// Runs a step and prints its progress to standard error. `name` says what the step does: "compile ...".
pub fn step<T>(name: &str, work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    let start = Instant::now();
    let (done, is_done) = channel::<()>();
    eprintln!("  {name} ...");
    thread::scope(|scope| {
        scope.spawn(move || {
            while let Err(RecvTimeoutError::Timeout) = is_done.recv_timeout(INTERVAL) {
                eprintln!("  {name} ... {} s so far", start.elapsed().as_secs());
            }
        });
        let result = work();
        drop(done);
        let outcome = if result.is_ok() { "done" } else { "failed" };
        eprintln!("  {name}: {outcome} after {:.1} s", start.elapsed().as_secs_f32());
        result
    })
}

//! Ctrl-C, and whatever else asks the process to end: a file that is being written is finished or withdrawn first, so that nothing half-written stays behind.

use std::sync::{Mutex, MutexGuard, PoisonError};

static WRITING: Mutex<()> = Mutex::new(());

/// The exit code of a program that was interrupted: 128 + SIGINT, for SIGTERM and SIGHUP as well.
const INTERRUPTED: i32 = 130;

/// From now on Ctrl-C, and on Unix SIGTERM and SIGHUP, wait for [`writing`]'s guard before the process ends.
pub fn wait_for_writes() {
    // A handler may be there already when the command runs inside another program; then that one decides.
    let _already_set = ctrlc::try_set_handler(|| {
        let _guard = writing();
        std::process::exit(INTERRUPTED);
    });
}

/// Held while files are written.
pub fn writing() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

//! Ctrl-C, and whatever else asks the process to end: a file that is being written is finished or withdrawn first, so that nothing half-written stays behind.

use std::process::exit;
use std::sync::{Mutex, MutexGuard, PoisonError};

static WRITING: Mutex<()> = Mutex::new(());

/// The exit code of a program that a signal ended is this and the signal's number.
const ENDED_BY: i32 = 128;

/// From now on Ctrl-C, SIGTERM and SIGHUP wait for [`writing`]'s guard before the process ends.
///
/// Each of them only where nobody else decides: a parent that has it ignored, as `nohup` does, or the program that the command runs inside.
#[cfg(unix)]
pub fn wait_for_writes() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    let ours = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&signal| ends_the_process(signal));
    // Where the system refuses, they end the process at once.
    let Ok(mut signals) = Signals::new(ours) else { return };
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            let _guard = writing();
            exit(ENDED_BY + signal);
        }
    });
}

/// Whether a signal is neither ignored nor handled.
#[cfg(unix)]
#[expect(unsafe_code, reason = "only the C library tells")]
fn ends_the_process(signal: libc::c_int) -> bool {
    let mut action = std::mem::MaybeUninit::<libc::sigaction>::uninit();
    // SAFETY: no action is given, so that none is changed; the present one is there where the call succeeds.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr()) == 0
            && action.assume_init().sa_sigaction == libc::SIG_DFL
    }
}

/// From now on Ctrl-C waits for [`writing`]'s guard before the process ends.
#[cfg(not(unix))]
pub fn wait_for_writes() {
    const SIGINT: i32 = 2;
    // A handler may be there already when the command runs inside another program; then that one decides.
    let _already_set = ctrlc::try_set_handler(|| {
        let _guard = writing();
        exit(ENDED_BY + SIGINT);
    });
}

/// Held while files are written.
pub fn writing() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

//! Ctrl-C, SIGTERM and SIGHUP: the process ends after the file that is being written is complete, so that no partial file remains.
//! SIGXFSZ, which a file larger than `ulimit -f` causes, becomes an error of the write.

use std::sync::{Mutex, MutexGuard, PoisonError};

static WRITING: Mutex<()> = Mutex::new(());

/// From now on Ctrl-C, SIGTERM and SIGHUP wait for the guard of [`writing`]; then the signal's default action ends the process.
///
/// A signal that is ignored, as under `nohup`, or that the program around this library handles, stays as it is.
#[cfg(unix)]
pub fn wait_for_writes() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    refuse_large_files();
    let unhandled = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&signal| has_default_action(signal));
    // If the system refuses, the signals end the process at once.
    let Ok(mut signals) = Signals::new(unhandled) else { return };
    let wait = move || {
        if let Some(signal) = signals.forever().next() {
            let _guard = writing();
            let _the_process_has_ended = emulate_default_handler(signal);
        }
    };
    let _signals_end_the_process_at_once = std::thread::Builder::new().spawn(wait);
}

/// Handles SIGXFSZ, whose default action would end the process and leave its temporary file: the write then fails with EFBIG.
#[cfg(unix)]
fn refuse_large_files() {
    use signal_hook::consts::SIGXFSZ;
    use signal_hook::flag;

    if has_default_action(SIGXFSZ) {
        let seen = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
        // If the system refuses, the signal ends the process, and the next run removes the file.
        let _default_action_stays = flag::register(SIGXFSZ, seen);
    }
}

/// Whether a signal is neither ignored nor handled.
#[cfg(unix)]
#[expect(unsafe_code, reason = "the current action can only be read with the C library")]
fn has_default_action(signal: libc::c_int) -> bool {
    let mut action = std::mem::MaybeUninit::<libc::sigaction>::uninit();
    // SAFETY: the new action is null, so no action is changed; `action` is initialised if the call succeeds.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr()) == 0
            && action.assume_init().sa_sigaction == libc::SIG_DFL
    }
}

/// From now on Ctrl-C waits for the guard of [`writing`] before the process ends.
#[cfg(not(unix))]
pub fn wait_for_writes() {
    /// The exit code of a program that Ctrl-C ended.
    const INTERRUPTED: i32 = 130;
    // A handler of the program around this library stays.
    let _already_set = ctrlc::try_set_handler(|| {
        let _guard = writing();
        std::process::exit(INTERRUPTED);
    });
}

/// The guard to hold while a file is written.
pub fn writing() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

//! Ctrl-C, SIGTERM and SIGHUP: the process ends after the file that is being renamed is complete, and without
//! temporary files, so that no partial file remains. A journal is told first. SIGXFSZ, which a file larger
//! than `ulimit -f` causes, becomes an error of the write.
//!
//! A thread waits for the signals, so nothing here runs inside a signal handler.

use std::fs::File;
use std::io::Write;
use std::sync::{Mutex, MutexGuard, PoisonError};

use darboux_io::discard_unfinished_outputs;

static WRITING: Mutex<()> = Mutex::new(());

/// What a journal gets when a signal ends the process.
static NOTE: Mutex<Option<(File, Vec<u8>)>> = Mutex::new(None);

/// From now on Ctrl-C, SIGTERM and SIGHUP wait for the guard of [`writing`]; then the signal's default action
/// ends the process.
///
/// A signal that is ignored, as under `nohup`, or that the program around this library handles, stays as it
/// is.
#[cfg(unix)]
pub fn wait_for_writes() {
    use std::sync::mpsc;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    refuse_large_files();
    let unhandled = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&signal| has_default_action(signal));
    let unhandled: Vec<_> = unhandled.collect();
    let (sender, is_ready) = mpsc::channel();
    let wait = move || {
        // If the system refuses, the signals end the process at once.
        let signals = Signals::new(unhandled);
        let _the_receiver_waits = sender.send(());
        if let Some(signal) = signals.ok().and_then(|mut signals| signals.forever().next()) {
            let _no_file_is_made_until_the_end = finish();
            let _the_process_has_ended = emulate_default_handler(signal);
        }
    };
    // Without a thread nobody would wait, so the signals are handled by the thread only.
    if std::thread::Builder::new().spawn(wait).is_ok() {
        let _without_a_message_there_is_no_thread = is_ready.recv();
    }
}

/// Tells the journal, waits for the file that is being renamed, and removes temporary files.
fn finish() -> impl Sized {
    if let Some((file, line)) = &mut *note() {
        let _cannot_be_reported = file.write_all(line);
    }
    let guard = writing();
    (guard, discard_unfinished_outputs())
}

/// A note that is written when a signal ends the process; dropped, it is not.
pub struct Note;

impl Note {
    /// `line`: what is appended to `file`.
    pub fn new(file: File, line: Vec<u8>) -> Self {
        *note() = Some((file, line));
        Self
    }
}

impl Drop for Note {
    fn drop(&mut self) {
        *note() = None;
    }
}

fn note() -> MutexGuard<'static, Option<(File, Vec<u8>)>> {
    NOTE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Handles SIGXFSZ, whose default action would end the process and leave its temporary file: the write then
/// fails with EFBIG.
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
        let _no_file_is_made_until_the_end = finish();
        std::process::exit(INTERRUPTED);
    });
}

/// The guard to hold while files get their names.
pub fn writing() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

//! Keeps messages of GPU drivers out of the output of the command.
//!
//! Vulkan drivers and layers print to standard error while an adapter is opened, for example Mesa:
//! "XDG_RUNTIME_DIR is invalid or not set", "lavapipe is not a conformant vulkan implementation". Users would
//! take such lines for errors of the command.

/// Runs `open` and discards what drivers print to standard error. If `open` fails, prints it after all,
/// because it may say why.
#[cfg(unix)]
pub fn without_driver_messages<T, E>(open: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    use std::io::{Read, Seek, Write};
    let Ok(mut redirected) = unix::Redirected::new() else { return open() };
    let opened = open();
    redirected.restore();
    if opened.is_err() {
        let mut messages = Vec::new();
        let read = redirected.file.rewind().and_then(|()| redirected.file.read_to_end(&mut messages));
        if read.is_ok() {
            // If standard error is closed, there is nowhere to print to.
            let _ignored = std::io::stderr().write_all(&messages);
        }
    }
    opened
}

/// Runs `open`. Only Unix has drivers that print.
#[cfg(not(unix))]
pub fn without_driver_messages<T, E>(open: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    open()
}

#[cfg(unix)]
mod unix {
    use std::fs::File;
    use std::io;
    use std::os::fd::{AsFd, OwnedFd};

    /// Standard error while it is redirected to a temporary file.
    pub struct Redirected {
        pub file: File,
        original: OwnedFd,
    }

    impl Redirected {
        pub fn new() -> io::Result<Self> {
            let file = tempfile::tempfile()?;
            let original = io::stderr().as_fd().try_clone_to_owned()?;
            rustix::stdio::dup2_stderr(&file)?;
            Ok(Self { file, original })
        }

        pub fn restore(&self) {
            // It fails only for an invalid descriptor, and this one is owned.
            let _ignored = rustix::stdio::dup2_stderr(&self.original);
        }
    }

    impl Drop for Redirected {
        /// Restores standard error after a panic too.
        fn drop(&mut self) {
            self.restore();
        }
    }
}

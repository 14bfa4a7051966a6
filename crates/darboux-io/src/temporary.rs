//! Temporary files: locked while their process runs, and known, so that a process which a signal ends can
//! remove them.

use std::collections::HashSet;
use std::fs::{File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

/// The random characters at the end of the names.
pub const RANDOM_CHARACTERS: usize = 6;

/// How many files are made at most until one can be locked.
const MOST_TRIES: usize = 16;

/// The paths of all temporary files of this process.
static PATHS: LazyLock<Mutex<HashSet<PathBuf>>> = LazyLock::new(Mutex::default);

/// A temporary file. Dropped, it is removed.
pub struct Temporary {
    file: NamedTempFile,
    // Dropped after the file.
    registered: Registered,
}

/// A path in the list, which is taken out when this is dropped.
struct Registered(PathBuf);

impl Drop for Registered {
    fn drop(&mut self) {
        paths().remove(&self.0);
    }
}

/// No temporary file is made while this exists.
pub struct Discarded(
    #[expect(dead_code, reason = "held until it is dropped")] MutexGuard<'static, HashSet<PathBuf>>,
);

/// Removes the temporary files of all outputs that this process has not finished. While the result exists, no
/// other is made.
///
/// For programs that a signal ends: they keep the result until their end. Outputs that are complete have
/// their names and stay.
pub fn discard_unfinished_outputs() -> Discarded {
    let paths = paths();
    for path in paths.iter() {
        // One that has its name by now is no longer there.
        let _cannot_be_reported = std::fs::remove_file(path);
    }
    Discarded(paths)
}

fn paths() -> MutexGuard<'static, HashSet<PathBuf>> {
    PATHS.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Temporary {
    /// Makes a locked file in a folder. `make` makes it, and fails where the name is taken. Errors do not
    /// name the file, since users do not know it.
    pub fn new(
        folder: &Path,
        prefix: &str,
        mut make: impl FnMut(&Path) -> io::Result<File>,
    ) -> io::Result<Self> {
        for _ in 0..MOST_TRIES {
            let temporary = Self::registered(folder, prefix, &mut make)?;
            match temporary.as_file().try_lock() {
                // Another process may have deleted the file as abandoned before it was locked.
                Ok(()) if !temporary.path().exists() => {}
                // Another process is about to do it, or has locked a file of which this is a second name.
                Err(TryLockError::WouldBlock) => {}
                // A file system without locks leaves abandoned files where they are.
                Ok(()) | Err(TryLockError::Error(_)) => return Ok(temporary),
            }
        }
        Err(io::Error::other("another process locks every new file in its folder"))
    }

    fn registered(
        folder: &Path,
        prefix: &str,
        make: &mut impl FnMut(&Path) -> io::Result<File>,
    ) -> io::Result<Self> {
        let mut paths = paths();
        let builder = &mut tempfile::Builder::new();
        let file = builder.prefix(prefix).rand_bytes(RANDOM_CHARACTERS).make_in(folder, make)?;
        let path = file.path().to_owned();
        paths.insert(path.clone());
        Ok(Self { file, registered: Registered(path) })
    }

    pub fn path(&self) -> &Path {
        self.file.path()
    }

    pub fn as_file(&self) -> &File {
        self.file.as_file()
    }

    pub fn as_file_mut(&mut self) -> &mut File {
        self.file.as_file_mut()
    }

    /// Renames the file to `target`, which is replaced if it exists. After an error, the file is removed.
    pub fn persist(self, target: &Path) -> io::Result<()> {
        self.file.persist(target).map(drop).map_err(|failed| failed.error)
    }

    /// Renames the file to `target`. Errors give it back; one is that `target` exists.
    pub fn persist_noclobber(self, target: &Path) -> Result<(), (Self, io::Error)> {
        let Self { file, registered } = self;
        match file.persist_noclobber(target) {
            Ok(_) => Ok(()),
            Err(failed) => Err((Self { file: failed.file, registered }, failed.error)),
        }
    }
}

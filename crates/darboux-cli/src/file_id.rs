//! Tells whether two paths name one file.

use std::path::{Path, PathBuf};

use crate::paths::canonical;

/// Equal for two paths if they name one file: through links, `./` or another name of the same file.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum FileId {
    /// The device and the number of a file that exists.
    #[cfg(unix)]
    Existing { device: u64, number: u64 },
    /// The canonical path.
    Named(PathBuf),
}

impl FileId {
    /// The identity of a file, which need not exist. The file is not opened, so that a FIFO does not block.
    pub fn of(path: &Path) -> Self {
        #[cfg(unix)]
        if let Ok(metadata) = path.metadata() {
            use std::os::unix::fs::MetadataExt;

            return Self::Existing { device: metadata.dev(), number: metadata.ino() };
        }
        Self::Named(canonical(path))
    }
}

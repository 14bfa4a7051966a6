//! The content of a file: read into memory or, on request and if it is large, mapped, so that it is neither copied nor read twice.

use std::fs::File;
use std::io::{self, Read};
use std::ops::Deref;
use std::path::Path;

use crate::paths;

/// The bytes of a file.
#[derive(Debug)]
pub enum FileBytes {
    /// Mapped by the operating system.
    #[cfg(unix)]
    Mapped(memmap2::Mmap),
    /// Read into memory.
    Read(Vec<u8>),
}

/// Files below this size are always read: that takes a twentieth of a second, and no other process can change what was read.
#[cfg(unix)]
const MAPPED_FROM: u64 = if cfg!(small_limits) { 1 } else { 256 << 20 };

/// How files are brought into memory: read by default.
#[derive(Clone, Copy, Debug, Default)]
pub struct FileAccess {
    maps: bool,
}

impl FileAccess {
    /// Large files are mapped where the system can.
    ///
    /// # Safety
    /// While a mapped file is in use, no process may write into it or shorten it.
    #[expect(unsafe_code, reason = "the caller vouches for other processes")]
    pub unsafe fn mapped() -> Self {
        Self { maps: true }
    }

    /// Opens a file at a path whose links were resolved before. A file that cannot be mapped is read.
    pub fn open(self, path: &Path) -> io::Result<FileBytes> {
        let mut file = paths::open_resolved(path)?;
        if let Some(mapped) = Some(&file).filter(|_| self.maps).and_then(map) {
            return Ok(mapped);
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        Ok(FileBytes::Read(bytes))
    }
}

/// The mapped file; none if it is small, or the system cannot map it.
#[cfg(unix)]
#[expect(unsafe_code, reason = "another process could change a mapped file")]
fn map(file: &File) -> Option<FileBytes> {
    if file.metadata().ok()?.len() < MAPPED_FROM {
        return None;
    }
    // SAFETY: only `FileAccess::mapped` makes a value that maps, and its caller has promised that no process changes the file. The map is only
    // read, and this crate never writes into a file that exists: outputs are new files, renamed when they are complete.
    let mapped = unsafe { memmap2::Mmap::map(file) }.ok()?;
    Some(FileBytes::Mapped(mapped))
}

/// None: on other systems a mapped file cannot be replaced, as writing in place does.
#[cfg(not(unix))]
fn map(_file: &File) -> Option<FileBytes> {
    None
}

impl Deref for FileBytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            #[cfg(unix)]
            Self::Mapped(map) => map,
            Self::Read(bytes) => bytes,
        }
    }
}

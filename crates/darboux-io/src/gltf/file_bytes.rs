//! The content of a file: read into memory or, on request and if it is large, mapped, so that it is neither
//! copied nor read twice.

use std::fs::{self, File};
use std::io::{self, Read};
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::paths;
use crate::source::FileSource;
use crate::{Files, files};

/// The bytes of a file.
#[derive(Debug)]
pub enum FileBytes {
    /// Mapped by the operating system.
    #[cfg(unix)]
    Mapped(memmap2::Mmap),
    /// Read into memory.
    Read(Vec<u8>),
    /// Made in memory: the bytes from `start` on.
    Made { bytes: Vec<u8>, start: usize },
}

/// Files below this size are always read: that takes a twentieth of a second, and no other process can change
/// what was read.
#[cfg(unix)]
const MAPPED_FROM: u64 = if cfg!(small_limits) { 1 } else { 256 << 20 };

/// Where files are, and how they are brought into memory: on the disk and read by default.
#[derive(Clone, Debug)]
pub enum FileAccess {
    /// On the disk. Large files are mapped, or not.
    Disk { maps: bool },
    /// Given by the program.
    Given(Arc<dyn Files>),
}

impl Default for FileAccess {
    fn default() -> Self {
        Self::Disk { maps: false }
    }
}

impl FileAccess {
    /// Large files are mapped where the system can.
    ///
    /// # Safety
    /// While a mapped file is in use, no process may write into it or shorten it.
    #[expect(unsafe_code, reason = "the caller vouches for other processes")]
    pub unsafe fn mapped() -> Self {
        Self::Disk { maps: true }
    }

    /// A path of a file or folder with links resolved. The names of given files have no links. Errors: on the
    /// disk, there is nothing at the path.
    pub fn resolved(&self, path: &Path) -> io::Result<PathBuf> {
        match self {
            Self::Disk { .. } => path.canonicalize(),
            Self::Given(_) => files::normalised(path).ok_or_else(|| io::ErrorKind::NotFound.into()),
        }
    }

    /// Where a model in a folder, if it has one, finds its files. Errors: there is no such folder.
    pub fn model_files(&self, folder: Option<&Path>) -> io::Result<FileSource> {
        Ok(match (self, folder) {
            (_, None) => FileSource::None,
            (Self::Disk { .. }, Some(folder)) => FileSource::Folder(folder.canonicalize()?),
            (Self::Given(given), Some(folder)) => FileSource::Given(Arc::clone(given), folder.to_owned()),
        })
    }

    /// Whether a resolved path is that of a regular file.
    pub fn is_file(&self, path: &Path) -> bool {
        match self {
            Self::Disk { .. } => fs::metadata(path).is_ok_and(|metadata| metadata.is_file()),
            Self::Given(files) => files.has(&files::name(path)),
        }
    }

    /// Opens a file at a path whose links were resolved before. A file that cannot be mapped is read. `most`:
    /// the bytes that the process may use. Errors: it cannot be opened or read; it is larger than that.
    pub fn open(&self, path: &Path, most: Option<u64>) -> io::Result<FileBytes> {
        let maps = match self {
            Self::Disk { maps } => *maps,
            Self::Given(files) => return files.read(&files::name(path)).map(FileBytes::Read),
        };
        let mut file = paths::open_resolved(path)?;
        let length = file.metadata()?.len();
        if most.is_some_and(|most| length > most) {
            return Err(too_large(length));
        }
        if let Some(mapped) = Some(&file).filter(|_| maps).and_then(map) {
            return Ok(mapped);
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        Ok(FileBytes::Read(bytes))
    }
}

fn too_large(length: u64) -> io::Error {
    let mebibytes = length.div_ceil(1 << 20);
    let sentence = format!(
        "its {mebibytes} MiB are more than the memory that this process may use; give the process more memory"
    );
    io::Error::new(io::ErrorKind::OutOfMemory, sentence)
}

/// The mapped file; none if it is small, or the system cannot map it.
#[cfg(unix)]
#[expect(unsafe_code, reason = "another process could change a mapped file")]
fn map(file: &File) -> Option<FileBytes> {
    if file.metadata().ok()?.len() < MAPPED_FROM {
        return None;
    }
    // SAFETY: only `FileAccess::mapped` makes a value that maps, and its caller has promised that no process
    // changes the file. The map is only read, and this crate never writes into a file that exists:
    // outputs are new files, renamed when they are complete.
    let mapped = unsafe { memmap2::Mmap::map(file) }.ok()?;
    Some(FileBytes::Mapped(mapped))
}

/// None: on other systems a mapped file cannot be replaced, as writing in place does.
#[cfg(not(unix))]
fn map(_file: &File) -> Option<FileBytes> {
    None
}

impl FileBytes {
    /// The bytes in memory of their own.
    pub fn into_vec(self) -> Vec<u8> {
        match self {
            #[cfg(unix)]
            Self::Mapped(map) => map.to_vec(),
            Self::Read(bytes) => bytes,
            Self::Made { mut bytes, start } => {
                bytes.drain(..start);
                bytes
            }
        }
    }
}

impl Deref for FileBytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            #[cfg(unix)]
            Self::Mapped(map) => map,
            Self::Read(bytes) => bytes,
            Self::Made { bytes, start } => &bytes[*start..],
        }
    }
}

//! The bytes of a file: mapped into memory where that works, so that a large model is neither copied nor read twice.

use std::fs::File;
use std::io::{self, Read};
use std::ops::Deref;
use std::path::Path;

/// The bytes of a file.
#[derive(Debug)]
pub enum FileBytes {
    /// As the system shows them.
    #[cfg(unix)]
    Mapped(memmap2::Mmap),
    /// Read.
    Read(Vec<u8>),
}

impl FileBytes {
    /// Opens a file. What cannot be mapped is read.
    pub fn open(path: &Path) -> io::Result<Self> {
        let mut file = File::open(path)?;
        if let Some(mapped) = map(&file) {
            return Ok(mapped);
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        Ok(Self::Read(bytes))
    }
}

/// The mapped file; none where the system cannot.
#[cfg(unix)]
#[expect(unsafe_code, reason = "what a map shows is another program's to change")]
fn map(file: &File) -> Option<FileBytes> {
    // SAFETY: the map is only read, and this program never writes into a file that exists: outputs are new files, renamed when they
    // are complete. Another program could write into it meanwhile. No decision is kept from bytes that are read again: JSON is
    // copied before it is looked at, every number is checked where it is used, in code that checks bounds, and floats may have any
    // value; such a change costs a wrong or refused result. A file that is cut short meanwhile ends this program by a signal
    // (SIGBUS) when the missing part is touched; outputs are not there yet then, a temporary file may stay behind.
    let mapped = unsafe { memmap2::Mmap::map(file) }.ok()?;
    (!mapped.is_empty()).then_some(FileBytes::Mapped(mapped))
}

/// None: elsewhere a file that is mapped cannot be replaced, as writing in place does.
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

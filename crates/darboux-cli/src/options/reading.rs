//! The options for reading a model: which files may be read, and how much memory reading may use.

use std::path::Path;

use clap::Args;
use darboux_io::gltf::{Document, LoadOptions};
use darboux_io::{Error, MemoryLimit};

/// How a model is read.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct ReadOptions {
    /// Allow a glTF's buffers and images outside its folder
    #[arg(long)]
    pub allow_outside: bool,

    /// The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file
    #[arg(long, value_name = "MIB")]
    pub memory_limit: Option<u32>,
}

impl ReadOptions {
    /// The limit on memory.
    pub fn memory_limit(&self) -> MemoryLimit {
        self.memory_limit
            .map_or(MemoryLimit::default(), |mebibytes| MemoryLimit::bytes(u64::from(mebibytes) << 20))
    }

    /// The options of the reader.
    pub fn load_options(&self) -> LoadOptions {
        LoadOptions { allow_outside: self.allow_outside, memory_limit: self.memory_limit() }
    }

    /// Opens a document with its files mapped into memory.
    #[expect(unsafe_code, reason = "mapping a file needs a promise about other processes")]
    pub fn open(&self, path: &Path) -> Result<Document, Error> {
        // SAFETY: nothing can stop other processes from changing a file, so this is what happens then. The reader copies JSON before it
        // parses it and checks every other number in the expression that uses it, so that changed bytes give a wrong result or an
        // error. A file that is shortened ends this process by a signal (SIGBUS) before the output is renamed to its name.
        unsafe { Document::open_mapped(path, &self.load_options()) }
    }
}

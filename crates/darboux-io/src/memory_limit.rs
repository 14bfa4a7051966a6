//! A limit on the memory that reading or processing a file may take, so that a small file cannot ask for all
//! of it.
//!
//! Compressed data, accessors over the same bytes, and lists of tiny primitives can need a thousand times the
//! size of their file. Each such request is estimated and compared with the limit before memory is allocated.

/// The most bytes that a file's content may take in memory. The default is 256 MiB and 64 times the size of
/// the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryLimit {
    /// The limit for files of any size; without it, the default.
    fixed: Option<u64>,
    /// What the whole process may use, which bounds the default.
    process: Option<u64>,
}

/// The default limit of an empty file.
const BASE: usize = 256 << 20;

/// What the default limit grows by for each byte of the file. Draco and meshopt compress honest meshes to a
/// twentieth and less.
const PER_BYTE: usize = 64;

/// What the default limit grows by for each byte that was decompressed. A corner has about ten such bytes.
const PER_DECOMPRESSED_BYTE: usize = 8;

/// The estimate for a corner whose tangents or normals are computed.
pub const BYTES_PER_CORNER: usize = 64;

/// The estimate for a primitive: its text, its parsed form, and its report.
pub const BYTES_PER_PRIMITIVE: usize = 4096;

impl MemoryLimit {
    /// A limit of `bytes` for files of any size.
    pub const fn bytes(bytes: u64) -> Self {
        Self { fixed: Some(bytes), process: None }
    }

    /// The default limit, and at most the `bytes` that the process may use, file included; none for a process
    /// without a limit.
    pub const fn of_process(bytes: Option<u64>) -> Self {
        Self { fixed: None, process: bytes }
    }

    /// What the process may use, where it bounds the limit.
    pub(crate) const fn process(self) -> Option<u64> {
        self.process
    }

    /// The limit for a file of `size` bytes that was decompressed into `decompressed` bytes.
    pub(crate) fn budget(self, size: usize, decompressed: usize, option: &'static str) -> Budget {
        if let Some(bytes) = self.fixed {
            return Budget {
                bytes: usize::try_from(bytes).unwrap_or(usize::MAX),
                is_of_process: false,
                option,
            };
        }
        let by_size = size
            .saturating_mul(PER_BYTE)
            .saturating_add(decompressed.saturating_mul(PER_DECOMPRESSED_BYTE))
            .saturating_add(BASE);
        let process = self.process.map_or(usize::MAX, |bytes| usize::try_from(bytes).unwrap_or(usize::MAX));
        let left = process.saturating_sub(size).saturating_sub(decompressed);
        Budget { bytes: by_size.min(left), is_of_process: left < by_size, option }
    }
}

/// The memory for one file.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// The most bytes.
    pub bytes: usize,
    /// Whether it is what the process may use.
    pub is_of_process: bool,
    /// The name of the option that changes the limit.
    pub option: &'static str,
}

impl Budget {
    /// What is wrong with a file that needs more, and what to do. `what` is a clause such as `the file
    /// decompresses to`.
    pub fn exceeded(&self, what: &str) -> String {
        let limit = self.bytes.div_ceil(1 << 20);
        let option = self.option;
        let (reason, advice) = if self.is_of_process {
            (", all that this process may use beside the file", "give the process more memory, or ")
        } else {
            ("", "")
        };
        format!(
            "{what} more than the memory limit of {limit} MiB{reason}; {advice}if you trust the file, raise \
             the limit ({option})"
        )
    }
}

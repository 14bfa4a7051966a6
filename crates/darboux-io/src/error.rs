//! What can be wrong with a file: one sentence that says which file, where in it, what is wrong and what to do.

use std::io;
use std::path::PathBuf;

use darboux::MeshError;

/// Why a file could not be read, processed or written. Its text is one sentence.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file breaks the format: truncated, out of range, of a wrong type.
    #[error("{file}: {}{problem}", prefix(at))]
    Invalid {
        /// The input, as the caller named it.
        file: String,
        /// The JSON path, such as `accessors[3].count`; empty where the whole file is meant.
        at: String,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// The file may be right, but it cannot be processed faithfully.
    #[error("{file}: {}{problem}", prefix(at))]
    Unsupported {
        /// The input, as the caller named it.
        file: String,
        /// The JSON path; empty where the whole file is meant.
        at: String,
        /// What is not supported, and what to do.
        problem: String,
    },
    /// A buffer or image outside the file cannot be used: missing, remote, or outside the input's folder.
    #[error("{file}: {}{problem}", prefix(at))]
    Resource {
        /// The input, as the caller named it.
        file: String,
        /// The JSON path of the reference.
        at: String,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// The mesh of a primitive is not one.
    #[error("{file}: {}{source}", prefix(at))]
    Mesh {
        /// The input, as the caller named it.
        file: String,
        /// The JSON path of the primitive.
        at: String,
        /// What is wrong with it.
        source: MeshError,
    },
    /// The operating system refuses to read.
    #[error("{}: cannot be read: {source}", file.display())]
    Read {
        /// Which file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The operating system refuses to write.
    #[error("{}: cannot be written: {source}", file.display())]
    Write {
        /// Which file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The output may not be written to that place, or not in that form.
    #[error("{}: {problem}", file.display())]
    Output {
        /// The output.
        file: PathBuf,
        /// What is wrong, and what to do.
        problem: String,
    },
}

fn prefix(at: &str) -> String {
    if at.is_empty() { String::new() } else { format!("{at}: ") }
}

/// A fault whose file is not known where it is found; [`Fault::in_file`] makes it an [`Error`].
#[derive(Debug)]
pub(crate) struct Fault {
    kind: FaultKind,
    at: String,
    problem: String,
}

#[derive(Clone, Copy, Debug)]
enum FaultKind {
    Invalid,
    Unsupported,
    Resource,
}

impl Fault {
    /// The format is broken at the JSON path `at` (empty: the whole file).
    pub fn invalid(at: impl Into<String>, problem: impl Into<String>) -> Self {
        Self { kind: FaultKind::Invalid, at: at.into(), problem: problem.into() }
    }

    /// The format is right at `at`, but cannot be processed faithfully.
    pub fn unsupported(at: impl Into<String>, problem: impl Into<String>) -> Self {
        Self { kind: FaultKind::Unsupported, at: at.into(), problem: problem.into() }
    }

    /// The resource that is named at `at` cannot be used.
    pub fn resource(at: impl Into<String>, problem: impl Into<String>) -> Self {
        Self { kind: FaultKind::Resource, at: at.into(), problem: problem.into() }
    }

    /// The error that names `file`.
    pub fn in_file(self, file: &str) -> Error {
        let Self { kind, at, problem } = self;
        let file = file.to_owned();
        match kind {
            FaultKind::Invalid => Error::Invalid { file, at, problem },
            FaultKind::Unsupported => Error::Unsupported { file, at, problem },
            FaultKind::Resource => Error::Resource { file, at, problem },
        }
    }
}

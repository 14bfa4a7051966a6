//! Errors about files: one sentence that names the file, the place in it, what is wrong and what to do.

use std::io;
use std::path::PathBuf;

/// Why a file was not read, processed or written. Its text is one sentence.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file violates its format: it is truncated, a value is out of range or has the wrong type.
    #[error("{file}: {}{problem}", prefix(at))]
    Invalid {
        /// The input, as the caller named it.
        file: String,
        /// The JSON path, such as `accessors[3].count`; empty for the whole file.
        at: String,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// The file may be valid, but cannot be processed without loss.
    #[error("{file}: {}{problem}", prefix(at))]
    Unsupported {
        /// The input, as the caller named it.
        file: String,
        /// The JSON path; empty for the whole file.
        at: String,
        /// What is not supported, and what to do.
        problem: String,
    },
    /// A buffer or image outside the file cannot be used: it is missing, remote, or outside the input's
    /// folder.
    #[error("{file}: {}{problem}", prefix(at))]
    Resource {
        /// The input, as the caller named it.
        file: String,
        /// The JSON path of the reference.
        at: String,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// The vertex data of a primitive is not a valid mesh.
    #[error("{file}: {}{}", prefix(at), advised(source))]
    Mesh {
        /// The input, as the caller named it.
        file: String,
        /// The JSON path of the primitive.
        at: String,
        /// What is wrong with the mesh.
        source: darboux::Error,
    },
    /// The operating system refuses to read a file.
    #[error("{}: cannot be read: {}{}", file.display(), system_reason(source), advice_on_reading(source))]
    Read {
        /// The file.
        file: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The operating system refuses to write a file.
    #[error("{}: cannot be written: {}{}", file.display(), system_reason(source), advice_on_writing(source))]
    Write {
        /// The file.
        file: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The output may not be written to this path, or not in this format.
    #[error("{}: {problem}", file.display())]
    Output {
        /// The output.
        file: PathBuf,
        /// What is wrong, and what to do.
        problem: String,
    },
}

/// The sentence about a mesh with what to do: the core does not know that the mesh comes from a file.
fn advised(source: &darboux::Error) -> String {
    let text = source.to_string();
    if text.contains("; ") { text } else { format!("{text}; export the file again") }
}

fn prefix(at: &str) -> String {
    if at.is_empty() { String::new() } else { format!("{at}: ") }
}

/// The most characters of a file's text in a message.
const LONGEST_QUOTE: usize = 200;

/// Text from a file as a message may show it: without characters that a terminal interprets, and at most 200
/// characters long.
pub(crate) fn shortened(text: &str) -> String {
    let printable = printable(text);
    match printable.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{}...", &printable[..end]),
        None => printable,
    }
}

/// Text from a file in quotes, [shortened]. Unlike `{:?}`, it leaves the `\` of Windows' paths single.
pub(crate) fn quoted(text: &str) -> String {
    format!("\"{}\"", shortened(text))
}

/// Escapes the characters that a terminal interprets: control characters, line breaks included, and marks of
/// text direction.
fn printable(text: &str) -> String {
    let is_unprintable = |c: char| {
        c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    let escape = |c: char| if is_unprintable(c) { c.escape_debug().to_string() } else { c.to_string() };
    text.chars().map(escape).collect()
}

/// An error in the content of a file whose name is not known yet. [`ContentError::in_file`] adds the name.
#[derive(Debug)]
pub(crate) struct ContentError {
    kind: ContentErrorKind,
    at: String,
    problem: String,
}

#[derive(Clone, Copy, Debug)]
enum ContentErrorKind {
    Invalid,
    Unsupported,
    Resource,
}

impl ContentError {
    /// The file violates its format at the JSON path `at`; an empty path means the whole file.
    pub fn invalid(at: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::new(ContentErrorKind::Invalid, &at.into(), &problem.into())
    }

    /// The content at `at` is valid, but cannot be processed without loss.
    pub fn unsupported(at: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::new(ContentErrorKind::Unsupported, &at.into(), &problem.into())
    }

    /// The file that is referred to at `at` cannot be used.
    pub fn resource(at: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::new(ContentErrorKind::Resource, &at.into(), &problem.into())
    }

    /// A JSON path contains names from the file, and the problem may quote it.
    fn new(kind: ContentErrorKind, at: &str, problem: &str) -> Self {
        Self { kind, at: shortened(at), problem: printable(problem) }
    }

    /// What is wrong, as a clause whose subject is the place.
    pub fn into_clause(self) -> String {
        self.problem
    }

    /// The error about `file`.
    pub fn in_file(self, file: &str) -> Error {
        let Self { kind, at, problem } = self;
        let file = file.to_owned();
        match kind {
            ContentErrorKind::Invalid => Error::Invalid { file, at, problem },
            ContentErrorKind::Unsupported => Error::Unsupported { file, at, problem },
            ContentErrorKind::Resource => Error::Resource { file, at, problem },
        }
    }
}

/// What the system says, without the number that Rust adds to it.
pub fn system_reason(error: &io::Error) -> String {
    let text = error.to_string();
    match (error.raw_os_error(), text.rfind(" (os error ")) {
        (Some(_), Some(end)) => text[..end].to_owned(),
        _ => text,
    }
}

/// What to do about a file that cannot be read, as a clause; empty where the system's reason says all.
fn advice_on_reading(reason: &io::Error) -> &'static str {
    match reason.kind() {
        io::ErrorKind::NotFound => "; check its name and folder",
        io::ErrorKind::PermissionDenied => "; change its permissions",
        _ => "",
    }
}

/// As [`advice_on_reading`], for a file that cannot be written.
fn advice_on_writing(reason: &io::Error) -> &'static str {
    match reason.kind() {
        io::ErrorKind::NotFound => "; make its folder first",
        io::ErrorKind::PermissionDenied => "; change the permissions of its folder",
        io::ErrorKind::StorageFull => "; free some space",
        io::ErrorKind::ReadOnlyFilesystem => "; name an output elsewhere",
        _ => "",
    }
}

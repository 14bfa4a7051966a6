//! Files that a program gives itself, such as a folder that was dropped on a web page.

use std::ffi::OsStr;
use std::fmt::Debug;
use std::io;
use std::path::{Component, Path, PathBuf};

use crate::code_page::decoded_name;

/// Files by name: a path without `.` and `..`, its parts separated by `/`.
///
/// [`Document::from_files`](crate::gltf::Document::from_files) reads those that a document refers to.
pub trait Files: Debug + Send + Sync {
    /// Whether there is a file with this name.
    fn has(&self, name: &str) -> bool;

    /// The content of a file. Errors: there is none with this name, or it cannot be read.
    fn read(&self, name: &str) -> io::Result<Vec<u8>>;
}

/// A relative path without `.` and `..`; none if it is absolute or leaves the folder of all files.
pub fn normalised(path: &Path) -> Option<PathBuf> {
    let mut parts: Vec<&OsStr> = Vec::new();
    for component in path.components() {
        match component {
            Component::Normal(part) => parts.push(part),
            Component::CurDir => {}
            Component::ParentDir => {
                parts.pop()?;
            }
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(parts.iter().collect())
}

/// The name of the file at a normalised path.
pub fn name(path: &Path) -> String {
    let parts: Vec<_> = path.iter().map(decoded_name).collect();
    parts.join("/")
}

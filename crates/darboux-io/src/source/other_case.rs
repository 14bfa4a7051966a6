//! Finds files whose names differ from a path in the case of letters only, as Windows does, or in the
//! encoding.

use std::collections::HashMap;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};

use crate::code_page::decoded_name;
use crate::files;

/// The most names that are listed for one model, all its folders together.
const MAX_LISTED: usize = 100_000;

/// No name of a file has more bytes.
const LONGEST_NAME: usize = 255;

/// The names in folders, listed once each.
#[derive(Debug)]
pub struct OtherCase {
    /// The names in each folder, links resolved, by their lower case, each list ascending.
    listed: HashMap<PathBuf, HashMap<String, Vec<OsString>>>,
    names_left: usize,
}

impl Default for OtherCase {
    fn default() -> Self {
        Self { listed: HashMap::new(), names_left: MAX_LISTED }
    }
}

impl OtherCase {
    /// The path, relative to `folder`, of what `relative` names without regard to case: of several names the
    /// one that is written so, or else the first in order. None where nothing is named so, and for a path
    /// that leaves `folder`, by a link as well. `may_look_up` is asked before each look at a folder
    /// below.
    ///
    /// `folder`: a path with links resolved.
    pub fn find(
        &mut self,
        folder: &Path,
        relative: &Path,
        may_look_up: impl Fn() -> bool,
    ) -> Option<PathBuf> {
        let mut found = PathBuf::new();
        for part in files::normalised(relative)?.iter() {
            let parent = if found.as_os_str().is_empty() {
                folder.to_owned()
            } else if may_look_up() {
                folder.join(&found).canonicalize().ok().filter(|path| path.starts_with(folder))?
            } else {
                return None;
            };
            found.push(self.name(parent, part)?);
        }
        Some(found)
    }

    fn name(&mut self, parent: PathBuf, wanted: &OsStr) -> Option<&OsString> {
        let Self { listed, names_left } = self;
        let of_folder = listed.entry(parent).or_insert_with_key(|parent| {
            let mut names: HashMap<String, Vec<OsString>> = HashMap::new();
            let entries = fs::read_dir(parent).into_iter().flatten().flatten();
            for name in entries.map(|entry| entry.file_name()).take(*names_left) {
                *names_left -= 1;
                names.entry(decoded_name(&name).to_lowercase()).or_default().push(name);
            }
            names.values_mut().for_each(|names| names.sort_unstable());
            names
        });
        let wanted_lower = wanted.to_str().filter(|name| name.len() <= LONGEST_NAME)?.to_lowercase();
        let names = of_folder.get(&wanted_lower)?;
        names.iter().find(|name| *name == wanted).or(names.first())
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// A link to its own folder gives one folder many paths.
    #[test]
    fn a_folder_is_listed_once_and_folders_are_listed_to_a_limit() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        std::os::unix::fs::symlink(".", root.join("a")).unwrap();
        fs::create_dir(root.join("b")).unwrap();
        for name in ["b/one", "b/two", "three"] {
            fs::write(root.join(name), "").unwrap();
        }
        let mut names = OtherCase::default();
        let path = Path::new("A/A/A/A/A/Three");
        assert_eq!(names.find(&root, path, || true), Some("a/a/a/a/a/three".into()));
        assert_eq!((names.listed.len(), MAX_LISTED - names.names_left), (1, 3));
        assert_eq!(names.find(&root, Path::new("B/Two"), || true), Some("b/two".into()));
        let mut few = OtherCase { names_left: 4, ..OtherCase::default() };
        assert!(few.find(&root, Path::new("B/Four"), || true).is_none());
        assert_eq!((few.names_left, few.listed.values().map(HashMap::len).sum::<usize>()), (0, 4));
    }
}

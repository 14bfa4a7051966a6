//! What lies in a folder: written before a run, compared after it.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use rustix::fs::{CWD, FileType, Mode, mknodat};

use super::case::{Case, Content};

/// The files below a folder by their relative paths. Folders without files do not appear.
pub type Tree = BTreeMap<PathBuf, Content>;

/// The folder in which command lines run, below the folder of a case.
pub const WORK: &str = "work";

/// Makes the folder of a case, empty but for its files. Errors: the system refuses.
pub fn make(folder: &Path, case: &Case) -> io::Result<()> {
    if folder.exists() {
        fs::remove_dir_all(folder)?;
    }
    let work = folder.join(WORK);
    fs::create_dir_all(&work)?;
    for (path, content) in &case.files {
        let path = work.join(path);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent)?;
        }
        match content {
            Content::Bytes(bytes) => fs::write(&path, bytes)?,
            Content::Fifo => mknodat(CWD, &path, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0)?,
            Content::Link(target) => std::os::unix::fs::symlink(target, &path)?,
        }
    }
    Ok(())
}

/// Reads a folder. Errors: the system refuses.
pub fn read(folder: &Path) -> io::Result<Tree> {
    let mut tree = Tree::new();
    let mut waiting = vec![PathBuf::new()];
    while let Some(below) = waiting.pop() {
        for entry in fs::read_dir(folder.join(&below))? {
            let entry = entry?;
            let (path, kind) = (below.join(entry.file_name()), entry.file_type()?);
            let content = if kind.is_dir() {
                waiting.push(path);
                continue;
            } else if kind.is_symlink() {
                Content::Link(fs::read_link(entry.path())?)
            } else if kind.is_file() {
                Content::Bytes(fs::read(entry.path())?)
            } else {
                Content::Fifo
            };
            tree.insert(path, content);
        }
    }
    Ok(tree)
}

/// Whether a path is a temporary file of the command.
pub fn is_temporary(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(".darboux-"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_made_is_read_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let case = Case::new(["inspect"])
            .file("a/b.glb", "x")
            .file("../outside", "y")
            .special("pipe", Content::Fifo)
            .special("link", Content::Link("../outside".into()));
        make(folder.path(), &case).expect("files");
        let tree = read(folder.path()).expect("files");
        let names: Vec<_> = tree.keys().map(|path| path.display().to_string()).collect();
        assert_eq!(names, ["outside", "work/a/b.glb", "work/link", "work/pipe"]);
        assert!(tree[Path::new("work/pipe")] == Content::Fifo);
        assert!(tree[Path::new("work/link")] == Content::Link("../outside".into()));
    }
}

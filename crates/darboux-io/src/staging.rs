//! Writing files whole or not at all: beside their targets first, then renamed together.

use std::fmt;
use std::fs::{self, File};
use std::io;
use std::num::ParseIntError;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use tempfile::TempPath;

use crate::Error;

/// Files written beside their targets, to be renamed together. Dropped before that, it removes everything it made.
pub struct Staging {
    run: Option<RunId>,
    staged: Vec<Staged>,
    made_folders: Vec<PathBuf>,
    renamed: Vec<PathBuf>,
}

struct Staged {
    temporary: TempPath,
    target: PathBuf,
    replace: bool,
}

/// How a document or an image is written.
#[derive(Clone, Copy, Debug, Default)]
pub struct SaveOptions {
    /// Replace an existing output; without, that is an error.
    pub force: bool,
    /// The run that this is a part of, if any.
    pub run: Option<RunId>,
}

/// A run of many files. Those that it has not completed are named after it, so that what it left when it was killed is known for its.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RunId(pub u64);

impl Staging {
    pub fn of_run(run: Option<RunId>) -> Self {
        Self { run, staged: Vec::new(), made_folders: Vec::new(), renamed: Vec::new() }
    }

    /// Writes the content of `target` to a file beside it, down to the disk.
    pub fn stage(
        &mut self,
        target: &Path,
        replace: bool,
        write: impl FnOnce(&mut File) -> io::Result<()>,
    ) -> Result<(), Error> {
        let failed = |source| Error::Write { file: target.to_owned(), source };
        let folder =
            target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        self.make_folders(folder).map_err(failed)?;
        let temporary = || -> io::Result<TempPath> {
            let mut file = new_file(folder, self.run)?;
            write(file.as_file_mut())?;
            if let Some(existing) = fs::metadata(target).ok().filter(|_| replace) {
                file.as_file().set_permissions(existing.permissions())?;
            }
            file.as_file().sync_all()?;
            Ok(file.into_temp_path())
        };
        let temporary = temporary().map_err(failed)?;
        self.staged.push(Staged { temporary, target: target.to_owned(), replace });
        Ok(())
    }

    fn make_folders(&mut self, folder: &Path) -> io::Result<()> {
        if folder.as_os_str().is_empty() || folder.is_dir() {
            return Ok(());
        }
        if let Some(parent) = folder.parent() {
            self.make_folders(parent)?;
        }
        fs::create_dir(folder)?;
        self.made_folders.push(folder.to_owned());
        Ok(())
    }

    /// Renames every file to its target, in the order of staging; gives the targets.
    pub fn commit(mut self) -> Result<Vec<PathBuf>, Error> {
        for Staged { temporary, target, replace } in std::mem::take(&mut self.staged) {
            let renamed =
                if replace { temporary.persist(&target) } else { temporary.persist_noclobber(&target) };
            renamed.map_err(|error| Error::Write { file: target.clone(), source: error.error })?;
            self.renamed.push(target);
        }
        self.made_folders.clear();
        Ok(std::mem::take(&mut self.renamed))
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // Temporary files first: their folders must be empty. A failure to clean up has no one to be told to.
        self.staged.clear();
        for file in &self.renamed {
            let _ = fs::remove_file(file);
        }
        for folder in self.made_folders.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// What the names of files begin with until they are complete.
const UNFINISHED: &str = ".darboux-";

impl RunId {
    /// What the names of this run's files begin with until they are complete.
    fn unfinished(self) -> String {
        format!("{UNFINISHED}{self}-")
    }

    /// The run that has not completed a file, by its name: where the run has ended, it was killed meanwhile.
    pub fn that_left(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?.strip_prefix(UNFINISHED)?;
        name.split_once('-')?.0.parse().ok()
    }
}

impl fmt::Display for RunId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl FromStr for RunId {
    type Err = ParseIntError;

    fn from_str(text: &str) -> Result<Self, ParseIntError> {
        u64::from_str_radix(text, 16).map(Self)
    }
}

/// A temporary file with the permissions of an ordinary new file. Its errors do not name it: nobody asked for it.
fn new_file(folder: &Path, run: Option<RunId>) -> io::Result<tempfile::NamedTempFile> {
    let prefix = run.map_or(UNFINISHED.into(), RunId::unfinished);
    tempfile::Builder::new().prefix(&prefix).make_in(folder, |path| File::create_new(path))
}

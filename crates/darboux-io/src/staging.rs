//! Writes files whole or not at all: first under a temporary name beside the target, then renamed.
//!
//! ```text
//! stage    writes a temporary file; commit renames it to its target     (documents, images)
//! publish  gives a temporary file its name at once, if the name is free  (buffers beside a document)
//! drop     without commit: removes everything that was made
//! ```
//!
//! A temporary file is locked while its process runs. A process that is killed leaves its temporary files
//! without a lock, and the next process that writes into the folder deletes them.

use std::collections::HashSet;
use std::fmt;
use std::fs::{self, File};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, ErrorKind, Write};
use std::num::ParseIntError;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::{LazyLock, Mutex, PoisonError};

use crate::temporary::{RANDOM_CHARACTERS, Temporary};
use crate::{Error, paths};

/// The files that one save writes. Dropped before [`Staging::commit`], it removes them.
pub struct Staging {
    run: Option<RunId>,
    /// Whether files are written; otherwise, one that would be written is an error.
    writes: bool,
    staged: Vec<Staged>,
    made_folders: Vec<PathBuf>,
    renamed: Vec<Renamed>,
}

/// A file that has its name, and what had it before, where that can still be needed.
struct Renamed {
    target: PathBuf,
    replaced: Option<Temporary>,
}

struct Staged {
    temporary: Temporary,
    target: PathBuf,
    replace: bool,
}

/// Several outputs that are written together or not at all: each is staged under a temporary name, and
/// [`Outputs::commit`] renames them all.
///
/// Dropped before, it removes what was staged.
pub struct Outputs {
    staging: Staging,
}

impl Outputs {
    /// No outputs yet. `run`: the run that they belong to, if any.
    pub fn new(run: Option<RunId>) -> Self {
        Self { staging: Staging::new(run) }
    }

    /// Renames every output to its name, in the order of staging. Returns all files written, buffers beside
    /// documents first. Errors: a file that cannot be renamed, or that was made by another process
    /// meanwhile where replacing was not permitted.
    pub fn commit(self) -> Result<Vec<PathBuf>, Error> {
        self.staging.commit()
    }

    /// Stages the content of a file of any kind. Errors: an existing file without [`SaveOptions::force`], or
    /// one that is not regular; a path that cannot be written.
    pub fn stage_bytes(&mut self, path: &Path, bytes: &[u8], options: &SaveOptions) -> Result<(), Error> {
        let target = paths::resolve_output(path, options.force, |_| None)?;
        self.staging.stage(&target, options.force, |file| file.write_all(bytes))
    }

    pub(crate) fn staging(&mut self) -> &mut Staging {
        &mut self.staging
    }
}

impl fmt::Debug for Outputs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.staging.staged.iter().map(|staged| &staged.target)).finish()
    }
}

/// How a document or an image is written.
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct SaveOptions {
    /// Replaces an existing output. Without it, an existing output is an error.
    pub force: bool,
    /// The run that the file belongs to, if any. Its temporary files are named after it.
    pub run: Option<RunId>,
}

impl SaveOptions {
    /// These options with an existing output replaced, or refused.
    #[must_use]
    pub const fn with_force(self, force: bool) -> Self {
        Self { force, ..self }
    }

    /// These options for a file of a run over many files.
    #[must_use]
    pub fn with_run(self, run: impl Into<Option<RunId>>) -> Self {
        Self { run: run.into(), ..self }
    }
}

/// The identifier of a run over many files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RunId(pub u64);

impl Staging {
    pub fn new(run: Option<RunId>) -> Self {
        Self { run, writes: true, staged: Vec::new(), made_folders: Vec::new(), renamed: Vec::new() }
    }

    /// For a comparison with what is there: a file that would have to be written is an error.
    pub fn comparing() -> Self {
        let mut staging = Self::new(None);
        staging.writes = false;
        staging
    }

    /// Writes a file, which [`Staging::commit`] renames to `target`. With `replace`, an existing target is
    /// replaced and its permissions are kept.
    pub fn stage(
        &mut self,
        target: &Path,
        replace: bool,
        write: impl FnOnce(&mut File) -> io::Result<()>,
    ) -> Result<(), Error> {
        let existing = fs::metadata(target).ok().filter(|_| replace);
        let temporary = self.write_temporary(target, write).and_then(|temporary| {
            if let Some(existing) = existing {
                temporary.as_file().set_permissions(existing.permissions())?;
            }
            Ok(temporary)
        });
        let temporary = temporary.map_err(|source| Error::Write { file: target.to_owned(), source })?;
        self.staged.push(Staged { temporary, target: target.to_owned(), replace });
        Ok(())
    }

    /// Writes a temporary file in the folder of `target`, down to the disk.
    pub fn write_temporary(
        &mut self,
        target: &Path,
        write: impl FnOnce(&mut File) -> io::Result<()>,
    ) -> io::Result<Temporary> {
        if !self.writes {
            return Err(ErrorKind::NotFound.into());
        }
        let folder =
            target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        self.make_folders(folder)?;
        remove_abandoned_files_once(folder);
        let mut temporary = new_temporary(folder, self.run)?;
        write(temporary.as_file_mut())?;
        temporary.as_file().sync_all()?;
        Ok(temporary)
    }

    /// Renames a temporary file to `target` at once; gives it back if a file of that name exists.
    pub fn publish(&mut self, temporary: Temporary, target: &Path) -> Result<Option<Temporary>, Error> {
        match temporary.persist_noclobber(target) {
            Ok(()) => {
                self.renamed.push(Renamed { target: target.to_owned(), replaced: None });
                Ok(None)
            }
            Err((temporary, error)) if error.kind() == ErrorKind::AlreadyExists => Ok(Some(temporary)),
            Err((_, source)) => Err(Error::Write { file: target.to_owned(), source }),
        }
    }

    fn make_folders(&mut self, folder: &Path) -> io::Result<()> {
        if folder.as_os_str().is_empty() || folder.is_dir() {
            return Ok(());
        }
        if let Some(parent) = folder.parent() {
            self.make_folders(parent)?;
        }
        match fs::create_dir(folder) {
            // Another process made it meanwhile.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => return Ok(()),
            made => made?,
        }
        self.made_folders.push(folder.to_owned());
        Ok(())
    }

    /// Renames every staged file to its target, in the order of staging. Returns all files written, published
    /// ones first. Where one cannot be renamed, files that were replaced before it come back.
    pub fn commit(mut self) -> Result<Vec<PathBuf>, Error> {
        let staged = std::mem::take(&mut self.staged);
        // Nothing can fail after the only file has its name.
        let keeps_replaced = staged.len() > 1;
        for Staged { temporary, target, replace } in staged {
            let failed = |source| Error::Write { file: target.clone(), source };
            let replaced = if keeps_replaced && replace {
                second_name(&target, self.run).map_err(failed)?
            } else {
                None
            };
            let renamed = match replace {
                true => temporary.persist(&target),
                false => temporary.persist_noclobber(&target).map_err(|(_, error)| error),
            };
            renamed.map_err(failed)?;
            self.renamed.push(Renamed { target, replaced });
        }
        self.made_folders.clear();
        Ok(self.renamed.drain(..).map(|renamed| renamed.target).collect())
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // Folders can be removed once they are empty. Failures to clean up cannot be reported from here.
        self.staged.clear();
        for Renamed { target, replaced } in self.renamed.drain(..).rev() {
            let _ = match replaced {
                Some(replaced) => replaced.persist(&target),
                None => fs::remove_file(target),
            };
        }
        for folder in self.made_folders.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// A temporary file that is a file under a second name, or its copy where the file system has no links.
/// `None` where there is no such file.
fn second_name(file: &Path, run: Option<RunId>) -> io::Result<Option<Temporary>> {
    if file.symlink_metadata().is_err() {
        return Ok(None);
    }
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut can_link = true;
    let second = Temporary::new(folder, &prefix_of(run), |path| {
        // If another process has locked the file, its link cannot be locked, and the next one is a copy.
        if std::mem::take(&mut can_link) {
            match fs::hard_link(file, path) {
                Err(error) if error.kind() != ErrorKind::AlreadyExists => {}
                linked => return linked.and_then(|()| File::open(path)),
            }
        }
        copy_to(file, path)
    })?;
    Ok(Some(second))
}

/// Copies a file to a path where nothing is. After an error, nothing is there.
fn copy_to(file: &Path, path: &Path) -> io::Result<File> {
    let mut copy = File::create_new(path)?;
    let copied = File::open(file).and_then(|mut file| {
        io::copy(&mut file, &mut copy)?;
        copy.set_permissions(file.metadata()?.permissions())
    });
    match copied {
        Ok(()) => Ok(copy),
        Err(error) => {
            let _the_first_error_counts = fs::remove_file(path);
            Err(error)
        }
    }
}

/// The prefix of temporary file names.
const PREFIX: &str = ".darboux-";

impl RunId {
    /// The beginning of the names of this run's temporary files.
    pub fn temporary_prefix(self) -> String {
        format!("{PREFIX}{self}-")
    }

    /// The run that made a temporary file, by the file's name: [`RunId::temporary_prefix`] and six random
    /// letters and digits, and nothing else.
    pub fn of_temporary_file(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?;
        let run: Self = name.strip_prefix(PREFIX)?.split_once('-')?.0.parse().ok()?;
        // The number has one spelling.
        name.strip_prefix(&run.temporary_prefix()).is_some_and(is_random).then_some(run)
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

/// A locked temporary file with the permissions of an ordinary new file. Errors do not name it, since users
/// do not know it.
fn new_temporary(folder: &Path, run: Option<RunId>) -> io::Result<Temporary> {
    Temporary::new(folder, &prefix_of(run), |path| File::create_new(path))
}

/// The prefix for a run, or for this process. Always with a number, so that no file of a user has such a
/// name.
fn prefix_of(run: Option<RunId>) -> String {
    // The hashers of the standard library start with random keys.
    static OF_PROCESS: LazyLock<RunId> = LazyLock::new(|| RunId(RandomState::new().build_hasher().finish()));
    run.unwrap_or(*OF_PROCESS).temporary_prefix()
}

/// Deletes the temporary files of processes that were killed, the first time that this process writes into a
/// folder.
fn remove_abandoned_files_once(folder: &Path) {
    static CLEANED_FOLDERS: LazyLock<Mutex<HashSet<PathBuf>>> = LazyLock::new(Mutex::default);
    let Ok(folder) = folder.canonicalize() else { return };
    if CLEANED_FOLDERS.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.clone()) {
        remove_abandoned_files(&folder);
    }
}

/// Whether a text is the end of the name of a temporary file.
fn is_random(text: &str) -> bool {
    text.len() == RANDOM_CHARACTERS && text.bytes().all(|byte| byte.is_ascii_alphanumeric())
}

fn remove_abandoned_files(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        let is_regular = || path.symlink_metadata().is_ok_and(|metadata| metadata.is_file());
        if RunId::of_temporary_file(&path).is_some() && is_regular() {
            let Ok(file) = paths::open_at_once(&path) else { continue };
            // The lock is held until the file is removed, so that its writer cannot lock the file in between.
            if file.try_lock().is_ok() {
                let _ = fs::remove_file(&path);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn temporary_files_of_killed_processes_are_removed_and_those_of_running_ones_stay() {
        let folder = tempfile::tempdir().unwrap();
        let abandoned = folder.path().join(".darboux-00000000000000fe-a1B2c3");
        // Names of six letters or digits, as a user may give them.
        let others =
            [".darboux-mine", ".darboux-ignore", ".darboux-config"].map(|name| folder.path().join(name));
        fs::write(&abandoned, "half").unwrap();
        others.iter().for_each(|other| fs::write(other, "whole").unwrap());
        let running = new_temporary(folder.path(), Some(RunId(7))).unwrap();
        remove_abandoned_files(folder.path());
        assert!(!abandoned.exists() && running.path().exists());
        assert!(others.iter().all(|other| other.exists()));
    }

    #[test]
    fn only_names_that_are_given_are_those_of_temporary_files() {
        let run = RunId(0xfe);
        let name = new_temporary(tempfile::tempdir().unwrap().path(), Some(run)).unwrap().path().to_owned();
        assert_eq!(RunId::of_temporary_file(&name), Some(run));
        let name = new_temporary(tempfile::tempdir().unwrap().path(), None).unwrap().path().to_owned();
        assert!(RunId::of_temporary_file(&name).is_some());
        for name in [
            ".darboux-00000000000000fe-notes.txt",
            ".darboux-00000000000000fe-a1B2c3d",
            ".darboux-00000000000000fe-a1B2c-",
            ".darboux-00000000000000fe-",
            ".darboux-00000000000000FE-a1B2c3",
            ".darboux-+0000000000000fe-a1B2c3",
            ".darboux-fe-a1B2c3",
            ".darboux-000000000000000fe-a1B2c3",
            ".darboux-a1B2c3-a1B2c3",
            "darboux-00000000000000fe-a1B2c3",
            ".darboux-notes",
            ".darboux-a1B2c3",
            ".darboux-a1B2c3.png",
            ".darboux-journal.jsonl",
        ] {
            assert_eq!(RunId::of_temporary_file(Path::new(name)), None, "{name}");
        }
    }

    /// The second target is a folder, which no file can replace.
    #[test]
    fn replaced_files_come_back_where_a_later_one_cannot_be_renamed() {
        let folder = tempfile::tempdir().unwrap();
        let [first, new, last] = ["first.png", "new.png", "last.png"].map(|name| folder.path().join(name));
        fs::write(&first, "before").unwrap();
        let mut staging = Staging::new(None);
        for target in [&first, &new, &last] {
            staging.stage(target, true, |file| file.write_all(b"after")).unwrap();
        }
        fs::create_dir(&last).unwrap();
        staging.commit().unwrap_err();
        assert_eq!(fs::read(&first).unwrap(), b"before");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "nothing else is left");
    }

    /// New contents for files that exist.
    fn staged_over(targets: &[PathBuf]) -> Staging {
        let mut staging = Staging::new(None);
        for target in targets {
            fs::write(target, "before").unwrap();
            staging.stage(target, true, |file| file.write_all(b"after")).unwrap();
        }
        staging
    }

    /// Its lock says nothing about the right to replace it, and waiting for it could take forever.
    #[test]
    fn a_file_that_another_process_has_locked_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let targets = ["a.png", "b.png"].map(|name| folder.path().join(name));
        let staging = staged_over(&targets);
        // Locks belong to open files: this one is not shared with the code below.
        let held = File::open(&targets[0]).unwrap();
        held.lock().unwrap();
        assert_eq!(staging.commit().unwrap(), targets);
        assert!(targets.iter().all(|target| fs::read(target).unwrap() == b"after"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "no second name is left");
    }

    #[test]
    fn a_locked_file_comes_back_where_a_later_one_cannot_be_renamed() {
        let folder = tempfile::tempdir().unwrap();
        let [first, last] = ["first.png", "last.png"].map(|name| folder.path().join(name));
        fs::write(&first, "before").unwrap();
        let mut staging = Staging::new(None);
        for target in [&first, &last] {
            staging.stage(target, true, |file| file.write_all(b"after")).unwrap();
        }
        fs::create_dir(&last).unwrap();
        let held = File::open(&first).unwrap();
        held.lock().unwrap();
        staging.commit().unwrap_err();
        assert_eq!(fs::read(&first).unwrap(), b"before");
    }

    #[test]
    fn all_files_are_replaced_together() {
        let folder = tempfile::tempdir().unwrap();
        let targets = ["a.png", "b.png"].map(|name| folder.path().join(name));
        let staging = staged_over(&targets);
        assert_eq!(staging.commit().unwrap(), targets);
        assert!(targets.iter().all(|target| fs::read(target).unwrap() == b"after"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "no second name is left");
    }

    #[test]
    fn a_published_file_never_replaces_another() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.bin");
        let mut staging = Staging::new(None);
        let mut temporary = || staging.write_temporary(&target, |_| Ok(())).unwrap();
        let (first, second) = (temporary(), temporary());
        assert!(staging.publish(first, &target).unwrap().is_none());
        let second = staging.publish(second, &target).unwrap().expect("the file is given back");
        drop((second, staging));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left without a commit");
    }
}

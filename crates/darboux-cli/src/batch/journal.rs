//! The journal of `--resume`: a file in the output folder with one line of JSON per run and one per finished
//! output.
//!
//! An output is up to date if its input's content, the options and the version equal its record, and every
//! file that was written with it still has the recorded hash. A broken line, as a killed process may leave
//! it, is ignored: its file is processed again. Temporary files carry the identifier of their run, so that
//! the files of killed runs are recognised and removed; no other file is removed. All paths are relative to
//! the folder, so that the folder can be moved. An output outside the folder (behind a link) is not recorded
//! and is processed again each time.
//!
//! A file is noted before it is begun. One that was at work when a run was killed is tried again alone, after
//! all others; one that was at work when two runs were killed is skipped and named, until --retry asks for
//! it. A run that a signal ends says so, and blames no file.
//!
//! An output that exists is replaced only if a run wrote it or may have written it: if it has a record, or
//! was noted and not finished.
//!
//! Lines are only appended while a run works. Opening the journal rewrites it without superseded lines once
//! they are the majority.

mod history;
mod record;

use std::fmt::Display;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use darboux_io::{RunId, system_reason};
use same_file::Handle;
use serde::Serialize;
use walkdir::WalkDir;

use self::history::{
    Begun, Ended, History, Interrupted, MOST_ATTEMPTS, Planned, RunStart, append_line, lines,
};
use self::record::relative_to;
pub use self::record::{OutputInputs, Record};
use crate::interrupt;
use crate::regular_file::{Links, open_regular};

const NAME: &str = "darboux-journal.jsonl";

/// The journal of an output folder. While it is open no other process can open it.
pub struct Journal {
    folder: PathBuf,
    file: File,
    run: RunId,
    /// What earlier runs wrote, and this run's identifier.
    history: History,
}

/// What earlier runs say about a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Earlier {
    /// No run was killed while it worked on the file.
    Harmless,
    /// One was.
    Suspect,
    /// Each of several was.
    Deadly,
}

/// Why a file is skipped: runs were killed while they worked on it.
pub fn skipped(file: &impl Display) -> String {
    format!(
        "{file}: is skipped, because two runs were killed while they worked on it, often for lack of memory; \
         give the process more memory, and try it again with --retry"
    )
}

impl Journal {
    /// Opens the journal of a folder, removes temporary files of killed runs, and records the start of `run`.
    /// A missing folder is created.
    ///
    /// Errors: another process has the journal open; it cannot be read or written.
    pub fn open(folder: &Path, run: RunId) -> Result<Self, String> {
        let path = folder.join(NAME);
        let failed = |error: io::Error| {
            format!(
                "{}: the journal cannot be opened: {}; remove it, or choose another folder",
                path.display(),
                system_reason(&error)
            )
        };
        fs::create_dir_all(folder).map_err(failed)?;
        let Some(mut file) = open_locked(&path).map_err(failed)? else {
            return Err(format!(
                "{}: another run is writing there; wait until it ends, or use another folder",
                folder.display()
            ));
        };
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(failed)?;
        let mut journal = Self { folder: folder.to_owned(), file, run, history: History::of(&bytes) };
        journal.remove_temporary_files()?;
        journal.history.runs.insert(run);
        let superseded_lines = lines(&bytes).count().saturating_sub(journal.history.line_count());
        if bytes.last().is_some_and(|&last| last != b'\n') {
            journal.file.write_all(b"\n").map_err(failed)?;
        }
        // Before the first temporary file of this run, so that a later run recognises it.
        journal.append(&RunStart { run: run.to_string() })?;
        if superseded_lines > journal.history.records.len() {
            // If this fails, the journal only stays long.
            let _ = journal.compact(&path);
        }
        Ok(journal)
    }

    /// Replaces the file by one that holds each run and each record once. A failure leaves the old file.
    fn compact(&mut self, path: &Path) -> io::Result<()> {
        let text = self.history.text(self.run)?;
        let _guard = interrupt::writing();
        let mut temporary = tempfile::Builder::new()
            .prefix(&self.run.temporary_prefix())
            .make_in(&self.folder, |path| File::create_new(path))?;
        // Locked before it has the journal's name, so that no other process can open it as its journal.
        let _without_locks_there_is_no_protection = temporary.as_file().try_lock();
        temporary.as_file().set_permissions(self.file.metadata()?.permissions())?;
        temporary.write_all(&text)?;
        temporary.as_file().sync_all()?;
        self.file = temporary.persist(path)?;
        Ok(())
    }

    /// Removes the temporary files of this run and of earlier ones. No worker may be running.
    pub fn remove_temporary_files(&self) -> Result<(), String> {
        let is_temporary =
            |path: &Path| RunId::of_temporary_file(path).is_some_and(|run| self.history.runs.contains(&run));
        for entry in WalkDir::new(&self.folder).into_iter().filter_map(Result::ok) {
            if entry.file_type().is_file() && is_temporary(entry.path()) {
                let removed = fs::remove_file(entry.path());
                removed.map_err(|error| {
                    format!("{}: cannot be removed: {}", entry.path().display(), system_reason(&error))
                })?;
            }
        }
        Ok(())
    }

    /// The folder of outputs.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Lets other processes open the journal.
    pub fn unlock(&self) -> Result<(), String> {
        self.file.unlock().map_err(|error| {
            format!("{}: cannot be unlocked: {}", self.folder.display(), system_reason(&error))
        })
    }

    /// Finds the record of an output.
    pub fn find(&self, output: &Path) -> Option<&Record> {
        self.history.records.get(&relative_to(&self.folder, output)?)
    }

    /// What earlier runs say about the work on an output.
    pub fn earlier(&self, output: &Path) -> Earlier {
        match self.attempts(output) {
            None | Some(0) => Earlier::Harmless,
            Some(count) if count < MOST_ATTEMPTS => Earlier::Suspect,
            Some(_) => Earlier::Deadly,
        }
    }

    /// Whether an earlier run may have written an output without leaving a record.
    pub fn may_have_written(&self, output: &Path) -> bool {
        self.attempts(output).is_some()
    }

    fn attempts(&self, output: &Path) -> Option<usize> {
        self.history.attempts(&relative_to(&self.folder, output)?)
    }

    /// Works on an output between two notes, so that a run that is killed meanwhile leaves its name. `work`
    /// returns the record to add, if there is one. None without work, where `retry` does not permit what
    /// earlier runs were killed at. Errors: the journal cannot be written.
    pub fn around<T>(
        &self,
        output: &Path,
        retry: bool,
        work: impl FnOnce() -> (T, Option<Record>),
    ) -> Result<Option<T>, String> {
        if self.earlier(output) == Earlier::Deadly && !retry {
            return Ok(None);
        }
        // An output outside the folder has no name here.
        let name = relative_to(&self.folder, output);
        if let Some(begun) = name.clone() {
            self.append(&Begun { begun })?;
        }
        let (done, record) = work();
        match (record, name) {
            (Some(record), _) => self.append(&record),
            (None, Some(ended)) => self.append(&Ended { ended }),
            (None, None) => Ok(()),
        }?;
        Ok(Some(done))
    }

    /// Notes an output that does not exist and will be written by processes that do not write the journal.
    pub fn plan(&self, output: &Path) -> Result<(), String> {
        relative_to(&self.folder, output).map_or(Ok(()), |planned| self.append(&Planned { planned }))
    }

    /// From now on a signal that ends the process is noted in the journal, so that no file is blamed. Until
    /// the result is dropped.
    pub fn note_interrupts(&self) -> Option<interrupt::Note> {
        let mut line = Vec::new();
        append_line(&mut line, &Interrupted { interrupted: self.run.to_string() }).ok()?;
        Some(interrupt::Note::new(self.file.try_clone().ok()?, line))
    }

    /// Adds a record.
    pub fn add(&self, record: &Record) -> Result<(), String> {
        self.append(record)
    }

    /// Writes one line.
    fn append(&self, value: &impl Serialize) -> Result<(), String> {
        let mut line = Vec::new();
        let written = append_line(&mut line, value).and_then(|()| (&self.file).write_all(&line));
        let path = self.folder.join(NAME);
        written.map_err(|error| format!("{}: cannot be written: {}", path.display(), system_reason(&error)))
    }
}

/// Opens and locks the journal's file; `None` if another process has locked it. A missing file is created. A
/// file system without locks gives no protection against a second run.
fn open_locked(path: &Path) -> io::Result<Option<File>> {
    loop {
        let mut options = OpenOptions::new();
        let file = open_regular(path, options.read(true).append(true).create(true), Links::Refuse)?;
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Ok(None);
        }
        // Between opening and locking, another run may have compacted the journal: then this file has lost
        // its name.
        let is_current = match Handle::from_path(path) {
            Ok(named) => named == Handle::from_file(file.try_clone()?)?,
            Err(error) => error.kind() != io::ErrorKind::NotFound,
        };
        if is_current {
            return Ok(Some(file));
        }
    }
}

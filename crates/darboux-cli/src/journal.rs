//! What is done in a folder of outputs, so that a run that was stopped can go on: one line of JSON per run that began, and one per output.
//!
//! An output is up to date while its input's content, the options and the version are those that it was made with, and all that was
//! written with it has the content that it had. A line that is broken, as a killed process may leave it, counts as none: its file is done
//! again. What killed runs have half-written is known by their names in the journal; nothing else is removed. All paths are below the folder,
//! so that it can be moved; an output that a link leads out of it is not noted, and is done again each time.

use std::collections::{HashMap, HashSet};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use darboux_io::RunId;
use darboux_io::gltf::{Document, LoadOptions};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use walkdir::WalkDir;

use crate::jobs::identity;
use crate::report::VERSION;

const NAME: &str = "darboux-journal.jsonl";

/// The journal of a folder. While it is open no other process can open it.
pub struct Journal {
    folder: PathBuf,
    file: File,
    /// All that ever began, this one too.
    runs: HashSet<RunId>,
    records: HashMap<String, Record>,
}

/// An output, and what it was made of.
#[derive(Clone, Serialize, Deserialize)]
pub struct Record {
    /// Below the folder.
    output: String,
    #[serde(flatten)]
    origin: Origin,
    /// What was written, below the folder, and BLAKE3 of its content.
    files: Vec<(String, String)>,
    /// What the report said of it, beyond what it says of all.
    pub summary: Map<String, Value>,
}

/// A run that begins.
#[derive(Serialize, Deserialize)]
struct Begun {
    run: String,
}

/// What decides an output.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    command: String,
    version: String,
    options: String,
    /// BLAKE3 of the input and of all files that it refers to.
    content: String,
}

impl Origin {
    /// What decides the output of `input` now. Errors: a file that cannot be read.
    pub fn new(command: &str, options: String, input: &Path, allow_outside: bool) -> Result<Self, String> {
        let content = content_of(input, allow_outside)
            .map_err(|(file, error)| format!("{}: cannot be read: {error}", file.display()))?;
        Ok(Self { command: command.into(), version: VERSION.into(), options, content })
    }
}

/// The hash of the hashes of all files. What is no model is a file of its own.
fn content_of(input: &Path, allow_outside: bool) -> Result<String, (PathBuf, io::Error)> {
    let document = Document::open(input, &LoadOptions { allow_outside });
    let files = document.map_or_else(|_| vec![input.to_owned()], |document| document.source_files());
    let mut all = blake3::Hasher::new();
    for file in files {
        let hash = hash_of(&file).map_err(|error| (file, error))?;
        all.update(hash.as_bytes());
    }
    Ok(all.finalize().to_hex().to_string())
}

fn hash_of(file: &Path) -> io::Result<blake3::Hash> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(File::open(file)?)?;
    Ok(hasher.finalize())
}

/// A number that no other run has.
pub fn new_run() -> RunId {
    // The standard library's hashers begin with random keys.
    RunId(RandomState::new().build_hasher().finish())
}

impl Record {
    /// The record of an output in `folder`, of which these files were written; none if one of them is elsewhere. Errors: a file that is
    /// gone already.
    pub fn new(
        folder: &Path,
        output: &Path,
        origin: Origin,
        written: &[String],
        summary: &impl Serialize,
    ) -> Result<Option<Self>, String> {
        let names = written.iter().map(|path| below(folder, Path::new(path)));
        let (Some(output), Some(names)) = (below(folder, output), names.collect::<Option<Vec<_>>>()) else {
            return Ok(None);
        };
        let hashed = |(name, path): (String, &String)| {
            let hash =
                hash_of(Path::new(path)).map_err(|error| format!("{path}: cannot be read again: {error}"))?;
            Ok((name, hash.to_hex().to_string()))
        };
        let files = names.into_iter().zip(written).map(hashed).collect::<Result<_, String>>()?;
        let summary = match serde_json::to_value(summary) {
            Ok(Value::Object(summary)) => summary,
            _ => Map::new(),
        };
        Ok(Some(Self { output, origin, files, summary }))
    }

    /// Whether an output of this origin is there, with all that was written with it, and as it was written.
    pub fn is_of(&self, origin: &Origin, folder: &Path) -> bool {
        let is_there = |(path, hash): &(String, String)| {
            let is_below = Path::new(path).is_relative();
            is_below && hash_of(&folder.join(path)).is_ok_and(|found| found.to_hex().as_str() == hash)
        };
        self.origin == *origin && self.files.iter().all(is_there)
    }
}

/// A path below the folder as text, the same on every system, whatever spells the two; none for what is elsewhere.
fn below(folder: &Path, path: &Path) -> Option<String> {
    let path = identity(path);
    let relative = path.strip_prefix(identity(folder)).ok()?;
    let names: Vec<_> = relative.iter().map(|name| name.to_string_lossy()).collect();
    Some(names.join("/"))
}

impl Journal {
    /// Opens the journal of a folder, which is made where it is missing, removes what killed runs left half-written there, and notes that
    /// `run` begins.
    ///
    /// Errors: another process has it open; the system refuses.
    pub fn open(folder: &Path, run: RunId) -> Result<Self, String> {
        let path = folder.join(NAME);
        let failed = |error: io::Error| format!("{}: cannot be opened: {error}", path.display());
        fs::create_dir_all(folder).map_err(failed)?;
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(&path).map_err(failed)?;
        // Where the file system has no locks, nobody watches over the folder but its owner.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(format!(
                "{}: another run is writing there; wait for its end or use another folder",
                folder.display()
            ));
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(failed)?;
        if bytes.last().is_some_and(|&last| last != b'\n') {
            file.write_all(b"\n").map_err(failed)?;
        }
        let mut journal =
            Self { folder: folder.to_owned(), file, runs: HashSet::new(), records: HashMap::new() };
        bytes.split(|&byte| byte == b'\n').for_each(|line| journal.read(line));
        journal.remove_left()?;
        journal.runs.insert(run);
        journal.append(&Begun { run: run.to_string() })?;
        Ok(journal)
    }

    /// Takes in a line, unless it is broken.
    fn read(&mut self, line: &[u8]) {
        if let Ok(record) = serde_json::from_slice::<Record>(line) {
            self.records.insert(record.output.clone(), record);
        } else if let Some(run) = serde_json::from_slice(line).ok().and_then(|Begun { run }| run.parse().ok())
        {
            self.runs.insert(run);
        }
    }

    /// Removes what this run and earlier ones left half-written. No worker may be at work.
    pub fn remove_left(&self) -> Result<(), String> {
        let is_left = |path: &Path| RunId::that_left(path).is_some_and(|run| self.runs.contains(&run));
        for entry in WalkDir::new(&self.folder).into_iter().filter_map(Result::ok) {
            if entry.file_type().is_file() && is_left(entry.path()) {
                let removed = fs::remove_file(entry.path());
                removed.map_err(|error| format!("{}: cannot be removed: {error}", entry.path().display()))?;
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
        self.file.unlock().map_err(|error| format!("{}: cannot be unlocked: {error}", self.folder.display()))
    }

    /// What is known of an output.
    pub fn find(&self, output: &Path) -> Option<&Record> {
        self.records.get(&below(&self.folder, output)?)
    }

    /// Adds what is done.
    pub fn add(&self, record: &Record) -> Result<(), String> {
        self.append(record)
    }

    /// Adds one line.
    fn append(&self, value: &impl Serialize) -> Result<(), String> {
        let line = serde_json::to_vec(value).map_err(io::Error::from);
        let written = line.and_then(|mut line| {
            line.push(b'\n');
            (&self.file).write_all(&line)
        });
        let path = self.folder.join(NAME);
        written.map_err(|error| format!("{}: cannot be written: {error}", path.display()))
    }
}

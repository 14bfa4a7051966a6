//! Turns the input arguments (files, folders, `-`) into the list of files that a command reads.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};

use darboux_io::{FileKind, LoadOptions, system_reason};
use walkdir::{DirEntry, WalkDir};

use crate::memory;
use crate::options::reading::missing_reader;
use crate::paths::canonical;
use crate::text::counted;

/// Where a file is read from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Input {
    Stdin,
    File(PathBuf),
}

impl fmt::Display for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Input::Stdin => f.write_str("<stdin>"),
            Input::File(path) => path.display().fmt(f),
        }
    }
}

impl Input {
    /// The size of the file in bytes, 0 where it is unknown.
    pub fn byte_length(&self) -> u64 {
        match self {
            Input::File(path) => Path::metadata(path).map_or(0, |metadata| metadata.len()),
            Input::Stdin => 0,
        }
    }

    /// The bytes that processing the file takes at most.
    pub fn memory(&self, options: &LoadOptions) -> u64 {
        match self {
            Input::File(path) => memory::of_file(path, options),
            Input::Stdin => memory::of_stream(),
        }
    }
}

/// Wrong usage, in one sentence.
#[derive(Debug, PartialEq, Eq)]
pub struct UsageError(pub String);

/// The suffixes of output names, by command. The suffixes of `convert` are conventions.
pub mod output_suffix {
    pub const TANGENTS: &str = "tangents";
    pub const NORMALS: &str = "normals";
    pub const FIXED: &str = "fixed";
    pub const ALL: [&str; 3] = [TANGENTS, NORMALS, FIXED];
}

/// Which models a folder search returns.
#[derive(Clone, Copy)]
pub enum SearchMode<'a> {
    /// All models.
    All,
    /// All models except those named like an output and those below the output folder.
    SkipOutputs {
        /// The output folder.
        out_dir: Option<&'a Path>,
        /// Whether inputs are replaced, which only glTF can be.
        in_place: bool,
    },
}

/// The result of a search.
#[derive(Debug, Default)]
pub struct FoundInputs {
    /// Each file, and the folder argument that it was found in, if any.
    pub files: Vec<(Input, Option<PathBuf>)>,
    /// Paths that cannot be searched or hold no model, each with the reason.
    pub failed: Vec<(PathBuf, String)>,
    /// Outputs of earlier runs, which are skipped.
    pub skipped: Vec<PathBuf>,
    /// Models in formats that this build, or none, reads, which are skipped: one sentence per folder and
    /// format.
    pub unread: Vec<String>,
}

/// Refuses standard input together with other inputs.
pub fn check_stdin(inputs: &[PathBuf]) -> Result<(), UsageError> {
    if inputs.len() > 1 && inputs.iter().any(|path| path == Path::new("-")) {
        return Err(UsageError("- (standard input) must be the only input".into()));
    }
    Ok(())
}

/// Searches the input arguments for models; folders are searched recursively, in the order of names.
///
/// A path that is not a folder counts as a file even if it does not exist: reading it reports the error.
pub fn find_inputs(inputs: &[PathBuf], mode: SearchMode) -> FoundInputs {
    let mut found = FoundInputs::default();
    for path in inputs {
        if path == Path::new("-") {
            found.files.push((Input::Stdin, None));
        } else if path.is_dir() {
            found.search(path, mode);
        } else if path.metadata().is_ok_and(|metadata| !metadata.is_file()) {
            let reason = "is not a regular file; save its content to a file, or pipe it to -";
            found.failed.push((path.clone(), reason.into()));
        } else {
            found.files.push((Input::File(path.clone()), None));
        }
    }
    found
}

impl FoundInputs {
    fn search(&mut self, folder: &Path, mode: SearchMode) {
        let before = self.found_count();
        let out_dir = match mode {
            SearchMode::SkipOutputs { out_dir: Some(out_dir), .. } => Some(canonical(out_dir)),
            _ => None,
        };
        let in_place = matches!(mode, SearchMode::SkipOutputs { in_place: true, .. });
        let mut unread: BTreeMap<&str, usize> = BTreeMap::new();
        let is_entered = |entry: &DirEntry| {
            entry.depth() == 0 || !entry.file_type().is_dir() || Some(canonical(entry.path())) != out_dir
        };
        for entry in WalkDir::new(folder).sort_by_file_name().into_iter().filter_entry(is_entered) {
            match entry {
                Ok(entry) if !entry.file_type().is_file() => {}
                Ok(entry) if !is_searched(entry.path(), in_place) => {
                    let known = FileKind::of(entry.path()).and_then(FileKind::format_name);
                    let format = known.or_else(|| format_of_others(entry.path()));
                    format.into_iter().for_each(|format| *unread.entry(format).or_default() += 1);
                }
                Ok(entry)
                    if matches!(mode, SearchMode::SkipOutputs { .. }) && has_output_name(entry.path()) =>
                {
                    self.skipped.push(entry.into_path());
                }
                Ok(entry) => self.files.push((Input::File(entry.into_path()), Some(folder.to_path_buf()))),
                Err(error) => {
                    let path = error.path().unwrap_or(folder).to_path_buf();
                    self.failed.push((path, format!("cannot be searched: {}", reason_of(error))));
                }
            }
        }
        let sentence = |(format, count)| unread_sentence(folder, format, count, in_place);
        self.unread.extend(unread.into_iter().map(sentence));
        if before == self.found_count() {
            let endings = if in_place { ".gltf, .glb, .vrm".to_owned() } else { FileKind::model_endings() };
            self.failed.push((folder.to_path_buf(), format!("the folder contains no model ({endings})")));
        }
    }

    /// The number of paths found, whatever becomes of them.
    fn found_count(&self) -> usize {
        self.files.len() + self.skipped.len() + self.failed.len()
    }
}

/// Whether a search finds the file. In place, only glTF is edited.
fn is_searched(path: &Path, in_place: bool) -> bool {
    FileKind::of(path).is_some_and(|kind| if in_place { kind.is_gltf() } else { kind.is_model() })
}

/// The endings of models of other programs, which no build reads, and the names of their formats.
const OTHER_FORMATS: [(&str, &str); 15] = [
    ("3dm", "Rhino"),
    ("3ds", "3DS"),
    ("3mf", "3MF"),
    ("abc", "Alembic"),
    ("blend", "Blender"),
    ("c4d", "Cinema 4D"),
    ("dae", "COLLADA"),
    ("lwo", "LightWave"),
    ("ma", "Maya"),
    ("max", "3ds Max"),
    ("mb", "Maya"),
    ("off", "OFF"),
    ("skp", "SketchUp"),
    ("wrl", "VRML"),
    ("x3d", "X3D"),
];

fn format_of_others(path: &Path) -> Option<&'static str> {
    let ending = path.extension()?;
    OTHER_FORMATS.iter().find(|(other, _)| ending.eq_ignore_ascii_case(other)).map(|&(_, format)| format)
}

/// The sentence about models of a format that a search skips.
fn unread_sentence(folder: &Path, format: &str, count: usize, in_place: bool) -> String {
    let files = counted(count, &format!("{format} file is"), &format!("{format} files are"));
    let reason = match format {
        "USD" => "darboux.usd in Python reads USD".to_owned(),
        _ if OTHER_FORMATS.iter().any(|&(_, other)| other == format) => {
            "its format is not read; export the models as .glb or .fbx".to_owned()
        }
        _ if in_place => "only glTF is edited in place, so name an output folder with --out-dir".to_owned(),
        _ => format!("this build does not read {format}; {}", missing_reader()),
    };
    format!("{}: {files} skipped: {reason}", folder.display())
}

fn reason_of(error: walkdir::Error) -> String {
    error.into_io_error().map_or("the folder contains itself".into(), |error| system_reason(&error))
}

/// Whether the file is named like an output for which no name was given, such as model.tangents.glb.
fn has_output_name(path: &Path) -> bool {
    let stem = Path::new(path.file_stem().unwrap_or_default());
    output_suffix::ALL.iter().any(|suffix| stem.extension() == Some(OsStr::new(suffix)))
}

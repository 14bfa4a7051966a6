//! Which file is read and which is written, decided and checked before any work.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};

use darboux_io::FileKind;
use walkdir::{DirEntry, WalkDir};

use crate::arguments::Files;

/// Where a file comes from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Input {
    Stdin,
    File(PathBuf),
}

/// Where a file goes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Output {
    Stdout,
    File(PathBuf),
}

/// One file's way.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Job {
    pub input: Input,
    pub output: Output,
}

/// The files below the arguments.
#[derive(Debug, Default)]
pub struct Found {
    /// Each file, and the folder argument that it was found in, if any.
    pub files: Vec<(Input, Option<PathBuf>)>,
    /// Places that could not be searched, or that hold no model, with the reason.
    pub failed: Vec<(PathBuf, String)>,
    /// How many earlier outputs were left out.
    pub left_out: usize,
}

/// Wrong usage, in one sentence.
#[derive(Debug, PartialEq, Eq)]
pub struct Usage(pub String);

impl fmt::Display for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Input::Stdin => f.write_str("<stdin>"),
            Input::File(path) => path.display().fmt(f),
        }
    }
}

impl fmt::Display for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Output::Stdout => f.write_str("<stdout>"),
            Output::File(path) => path.display().fmt(f),
        }
    }
}

/// Which models a search of folders takes.
#[derive(Clone, Copy)]
pub enum Scan<'a> {
    /// All.
    All,
    /// Neither those with an output's name nor those below the folder of outputs.
    Sources {
        /// That folder.
        out_dir: Option<&'a Path>,
    },
}

/// Searches the arguments for models: folders recursively, in the order of names.
///
/// A path that is no folder is taken as a file, missing ones too: reading it says what is wrong.
pub fn find(inputs: &[PathBuf], scan: Scan) -> Found {
    let mut found = Found::default();
    for path in inputs {
        if path == Path::new("-") {
            found.files.push((Input::Stdin, None));
        } else if path.is_dir() {
            found.search(path, scan);
        } else if path.metadata().is_ok_and(|metadata| !metadata.is_file()) {
            let reason = "is not a regular file; save its content as one, or read it from a pipe as -";
            found.failed.push((path.clone(), reason.into()));
        } else {
            found.files.push((Input::File(path.clone()), None));
        }
    }
    found
}

impl Found {
    fn search(&mut self, folder: &Path, scan: Scan) {
        let before = (self.files.len(), self.left_out, self.failed.len());
        let out_dir = match scan {
            Scan::Sources { out_dir: Some(out_dir) } => Some(identity(out_dir)),
            _ => None,
        };
        let entered = |entry: &DirEntry| {
            entry.depth() == 0 || !entry.file_type().is_dir() || Some(identity(entry.path())) != out_dir
        };
        for entry in WalkDir::new(folder).sort_by_file_name().into_iter().filter_entry(entered) {
            match entry {
                Ok(entry) if !entry.file_type().is_file() || !is_model(entry.path()) => {}
                Ok(entry) if matches!(scan, Scan::Sources { .. }) && is_output(entry.path()) => {
                    self.left_out += 1
                }
                Ok(entry) => self.files.push((Input::File(entry.into_path()), Some(folder.to_path_buf()))),
                Err(error) => {
                    let path = error.path().unwrap_or(folder).to_path_buf();
                    self.failed.push((path, format!("cannot be searched: {}", reason(error))));
                }
            }
        }
        if before == (self.files.len(), self.left_out, self.failed.len()) {
            self.failed.push((folder.to_path_buf(), "the folder holds no model (.gltf, .glb, .vrm)".into()));
        }
    }
}

fn reason(error: walkdir::Error) -> String {
    error.into_io_error().map_or("it contains itself".into(), |error| error.to_string())
}

/// What a command writes.
#[derive(Clone, Copy, Debug)]
pub struct Rules<'a> {
    /// What the names of its outputs get.
    pub word: &'a str,
    /// A report, too, on standard output.
    pub json: bool,
    /// Images as well as models.
    pub images: bool,
}

impl Rules<'_> {
    fn takes(self, path: &Path) -> bool {
        is_model(path) || (self.images && is_png(path))
    }
}

/// The jobs of a command that writes files, in the order of the inputs, each once.
///
/// Errors: an output that does not fit the inputs, two inputs with one output, an output that is an input, a file and a report both for
/// standard output.
pub fn plan(files: &Files, rules: Rules<'_>, found: &Found) -> Result<Vec<Job>, Usage> {
    check_usage(files, rules)?;
    let mut jobs = Vec::new();
    let mut input_of_output: HashMap<PathBuf, &Input> = HashMap::new();
    for (input, folder) in &found.files {
        let output = destination(files, rules, input, folder.as_deref());
        if let Output::File(path) = &output {
            match input_of_output.insert(identity(path), input) {
                Some(other) if other == input => continue,
                Some(other) => {
                    return Err(Usage(format!(
                        "{other} and {input} would both be written to {output}; give them different folders"
                    )));
                }
                None => {}
            }
        }
        jobs.push(Job { input: input.clone(), output });
    }
    if !files.in_place {
        check_inputs_survive(&jobs, &input_of_output)?;
    }
    Ok(jobs)
}

/// Errors: standard input beside other inputs.
pub fn check_stdin(inputs: &[PathBuf]) -> Result<(), Usage> {
    if inputs.len() > 1 && inputs.iter().any(|path| path == Path::new("-")) {
        return Err(Usage("- (standard input) must be the only input".into()));
    }
    Ok(())
}

fn check_usage(files: &Files, rules: Rules<'_>) -> Result<(), Usage> {
    let usage = |message: &str| Err(Usage(message.into()));
    check_stdin(&files.inputs)?;
    let stdin = files.inputs[0] == Path::new("-");
    if stdin && (files.in_place || files.out_dir.is_some()) {
        return usage("standard input has no name and no place; use -o FILE");
    }
    if let Some(file) = files.out_dir.as_ref().filter(|path| path.exists() && !path.is_dir()) {
        return Err(Usage(format!(
            "{} is not a folder; name one, or use -o FILE for a single output",
            file.display()
        )));
    }
    let Some(output) = &files.output else {
        return match rules.json && stdin {
            true => usage("the file and the report cannot both go to standard output; use -o FILE"),
            false => Ok(()),
        };
    };
    if files.inputs.len() > 1 {
        return usage("-o takes a single input; use --out-dir for several");
    }
    if files.inputs[0].is_dir() {
        return usage("-o takes a single file, but the input is a folder; use --out-dir");
    }
    if output == Path::new("-") {
        return match rules.json {
            true => usage("the file and the report cannot both go to standard output; use -o FILE"),
            false => Ok(()),
        };
    }
    if output.is_dir() {
        return Err(Usage(format!("{} is a folder; use --out-dir", output.display())));
    }
    if !rules.takes(output) {
        let extensions = if rules.images { ".glb, .vrm, .gltf or .png" } else { ".glb, .vrm or .gltf" };
        return Err(Usage(format!("{} must end in {extensions}", output.display())));
    }
    refuse_missing_folder(output).map_err(Usage)
}

/// Says that the folder of a named output is not there: most likely its name is mistyped.
pub fn refuse_missing_folder(output: &Path) -> Result<(), String> {
    match output.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.exists()) {
        Some(folder) => Err(format!(
            "{}: there is no folder {}; make it, or name another one",
            output.display(),
            folder.display()
        )),
        None => Ok(()),
    }
}

fn destination(files: &Files, rules: Rules<'_>, input: &Input, folder: Option<&Path>) -> Output {
    let path = match (&files.output, input) {
        (Some(output), _) if output != Path::new("-") => return Output::File(output.clone()),
        (Some(_), _) | (None, Input::Stdin) => return Output::Stdout,
        (None, Input::File(path)) => path,
    };
    Output::File(match &files.out_dir {
        Some(out_dir) => {
            let name = || Path::new(path.file_name().unwrap_or_default());
            let kept = folder.and_then(|folder| path.strip_prefix(folder).ok());
            let kept = out_dir.join(kept.unwrap_or_else(name));
            if rules.takes(&kept) { kept } else { kept.with_extension("glb") }
        }
        None if files.in_place => path.clone(),
        None => {
            let extension = if rules.takes(path) { path.extension() } else { None };
            let extension = extension.unwrap_or(OsStr::new("glb"));
            let mut name = path.file_stem().unwrap_or_default().to_os_string();
            name.push(format!(".{}.", rules.word));
            name.push(extension);
            path.with_file_name(name)
        }
    })
}

fn check_inputs_survive(jobs: &[Job], input_of_output: &HashMap<PathBuf, &Input>) -> Result<(), Usage> {
    for job in jobs {
        let Input::File(path) = &job.input else { continue };
        if let Some(&writer) = input_of_output.get(&identity(path)) {
            let whose = if *writer == job.input {
                "its own output".into()
            } else {
                format!("the output of {writer}")
            };
            return Err(Usage(format!(
                "{} would be replaced by {whose}; name another output, or use --in-place to replace inputs",
                path.display()
            )));
        }
    }
    Ok(())
}

/// One path for all spellings of a file's path, whether it exists yet or not.
pub fn identity(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    for ancestor in path.ancestors() {
        if let Ok(existing) = ancestor.canonicalize() {
            return match path.strip_prefix(ancestor) {
                Ok(rest) if rest != Path::new("") => existing.join(rest),
                _ => existing,
            };
        }
    }
    path
}

fn is_model(path: &Path) -> bool {
    FileKind::of(path).is_some_and(FileKind::is_model)
}

/// True for .png.
pub fn is_png(path: &Path) -> bool {
    FileKind::of(path) == Some(FileKind::Png)
}

/// The words in the names of outputs, by command. Those of `convert` are conventions.
pub mod word {
    pub const TANGENTS: &str = "tangents";
    pub const NORMALS: &str = "normals";
    pub const ALL: [&str; 2] = [TANGENTS, NORMALS];
}

/// True for names that outputs get when none is given.
fn is_output(path: &Path) -> bool {
    let stem = Path::new(path.file_stem().unwrap_or_default());
    word::ALL.iter().any(|word| stem.extension() == Some(OsStr::new(word)))
}

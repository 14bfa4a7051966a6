//! What a journal records of an output: everything that it depends on, and the files written.

use std::fs::OpenOptions;
use std::io;
#[cfg(feature = "bake")]
use std::path::PathBuf;
use std::path::{Component, Path};

use darboux_io::source::PolygonRule;
use darboux_io::system_reason;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::json::VERSION;
use crate::options::reading::ReadOptions;
use crate::paths::canonical;
use crate::regular_file::{Links, open_regular};

/// The record of an output.
#[derive(Clone, Serialize, Deserialize)]
pub struct Record {
    /// The path relative to the folder.
    pub(super) output: String,
    #[serde(flatten)]
    inputs: OutputInputs,
    /// The relative paths of all files written, and the BLAKE3 hashes of their contents.
    files: Vec<(String, String)>,
    /// The command's part of the report.
    pub summary: Map<String, Value>,
}

/// Everything that an output depends on.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutputInputs {
    command: String,
    version: String,
    options: String,
    /// The BLAKE3 hash of the input and of all files that it refers to.
    content: String,
    /// The same of the file that all outputs depend on.
    #[serde(default)]
    common_content: Option<String>,
}

impl OutputInputs {
    /// What the output of `input` depends on now. Errors: a file cannot be read.
    pub fn new(command: &str, options: String, input: &Path, reading: &ReadOptions) -> Result<Self, String> {
        let content = content_of(input, reading)?;
        let rule = reading.polygons;
        let is_default = rule == PolygonRule::default();
        let options = if is_default { options } else { format!("{options}, polygons {rule:?}") };
        Ok(Self { command: command.into(), version: VERSION.into(), options, content, common_content: None })
    }

    /// The same for an output that depends on another file, too. Errors: it cannot be read.
    pub fn with_common_input(self, input: Option<&Path>, reading: &ReadOptions) -> Result<Self, String> {
        let common_content = input.map(|input| content_of(input, reading)).transpose()?;
        Ok(Self { common_content, ..self })
    }
}

/// Hashes the hashes of a model and of all files that it refers to, or of the file alone if it cannot be read
/// as a model.
fn content_of(input: &Path, reading: &ReadOptions) -> Result<String, String> {
    let document = reading.open(input);
    let files = document.map_or_else(|_| vec![input.to_owned()], |document| document.source_files());
    let mut all = blake3::Hasher::new();
    for file in files {
        let hash = hash_of(&file, Links::Follow)
            .map_err(|error| format!("{}: cannot be read: {}", file.display(), system_reason(&error)))?;
        all.update(hash.as_bytes());
    }
    Ok(all.finalize().to_hex().to_string())
}

fn hash_of(file: &Path, links: Links) -> io::Result<blake3::Hash> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(open_regular(file, OpenOptions::new().read(true), links)?)?;
    Ok(hasher.finalize())
}

impl Record {
    /// The record of an output with all files written for it; `None` if one of them is outside `folder`.
    /// Errors: a written file cannot be read again.
    pub fn new(
        folder: &Path,
        output: &Path,
        inputs: OutputInputs,
        written: &[String],
        summary: &impl Serialize,
    ) -> Result<Option<Self>, String> {
        let names = written.iter().map(|path| relative_to(folder, Path::new(path)));
        let (Some(output), Some(names)) = (relative_to(folder, output), names.collect::<Option<Vec<_>>>())
        else {
            return Ok(None);
        };
        let hashed = |(name, path): (String, &String)| {
            let hash = hash_of(Path::new(path), Links::Follow)
                .map_err(|error| format!("{path}: cannot be read again: {}", system_reason(&error)))?;
            Ok((name, hash.to_hex().to_string()))
        };
        let files = names.into_iter().zip(written).map(hashed).collect::<Result<_, String>>()?;
        let summary = match serde_json::to_value(summary) {
            Ok(Value::Object(summary)) => summary,
            _ => Map::new(),
        };
        Ok(Some(Self { output, inputs, files, summary }))
    }

    /// The files that were written with the output.
    #[cfg(feature = "bake")]
    pub fn files(&self, folder: &Path) -> Vec<PathBuf> {
        self.files.iter().map(|(name, _)| folder.join(name)).collect()
    }

    /// Whether the inputs are the recorded ones and every written file still has its recorded content.
    pub fn is_up_to_date(&self, inputs: &OutputInputs, folder: &Path) -> bool {
        let is_unchanged = |(path, hash): &(String, String)| {
            let mut parts = Path::new(path).components();
            let is_inside = parts.all(|part| matches!(part, Component::Normal(_)));
            is_inside
                && hash_of(&folder.join(path), Links::Follow)
                    .is_ok_and(|found| found.to_hex().as_str() == hash)
        };
        self.inputs == *inputs && self.files.iter().all(is_unchanged)
    }
}

/// The path relative to the folder, with `/` on every system; `None` for a path outside the folder.
pub(super) fn relative_to(folder: &Path, path: &Path) -> Option<String> {
    let path = canonical(path);
    let relative = path.strip_prefix(canonical(folder)).ok()?;
    let names: Vec<_> = relative.iter().map(|name| name.to_string_lossy()).collect();
    Some(names.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A journal may come from a stranger, and names files to read.
    #[test]
    fn files_outside_of_the_folder_are_not_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let inside = folder.path().join("out");
        std::fs::create_dir(&inside).expect("a folder");
        let content = blake3::hash(b"x").to_hex().to_string();
        for path in [folder.path().join("a"), inside.join("a")] {
            std::fs::write(path, b"x").expect("a file");
        }
        let inputs = OutputInputs {
            command: "tangents".into(),
            version: VERSION.into(),
            options: String::new(),
            content: content.clone(),
            common_content: None,
        };
        let of = |name: &str| {
            let files = vec![(name.to_owned(), content.clone())];
            let summary = Map::new();
            let record = Record { output: "a".into(), inputs: inputs.clone(), files, summary };
            record.is_up_to_date(&inputs, &inside)
        };
        assert!(of("a"));
        assert!(!of("../a") && !of("b/../../a"));
    }
}

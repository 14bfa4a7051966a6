//! Refuses outputs that would replace an input, or each other, before any ray is followed.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use darboux_io::gltf::Document;

use super::arguments::BakeArguments;
use super::outputs::{all_outputs, picture_of_misses};
use super::skew::SkewChoice;
use super::tile_names::{self, has_place};
use crate::file_id::FileId;

/// A file that is read.
#[derive(Clone, Debug)]
pub struct InputFile {
    pub path: PathBuf,
    /// What the file is: a noun phrase.
    pub role: String,
}

/// A file that is written.
#[derive(Clone, Debug)]
pub struct OutputFile {
    pub path: PathBuf,
    /// The number of the bake in its job.
    bake: usize,
    /// Whether it is written for some results only.
    is_occasional: bool,
}

/// The files that the arguments name for reading. [`files_of`] has the files that models refer to, once the
/// models are open.
pub fn all_inputs(arguments: &BakeArguments) -> Vec<InputFile> {
    let BakeArguments { low, high, cage, skew, .. } = arguments;
    let input = |path: &PathBuf, role: &str| InputFile { path: path.clone(), role: role.to_owned() };
    let skew = match skew {
        Some(SkewChoice::Image(path)) => Some(input(path, "the image of --skew")),
        _ => None,
    };
    let low = input(low, "the low model");
    let high = high.iter().map(|path| input(path, "a high model"));
    let cage = cage.iter().map(|path| input(path, "the cage"));
    [low].into_iter().chain(high).chain(cage).chain(skew).collect()
}

/// The files of a model: its own, and those that it refers to.
pub fn files_of(document: &Document) -> Vec<InputFile> {
    let role = || format!("a file of {}", document.name());
    document.source_files().into_iter().map(|path| InputFile { path, role: role() }).collect()
}

/// Every file that a bake may write. `bake`: its number in its job.
pub fn outputs_of(arguments: &BakeArguments, bake: usize) -> Vec<OutputFile> {
    let always = all_outputs(arguments).into_iter().map(|path| (path, false));
    let all = always.chain([(picture_of_misses(arguments), true)]);
    all.map(|(path, is_occasional)| OutputFile { path, bake, is_occasional }).collect()
}

/// Refuses a file that would be written twice, or over an input: also one that `%UDIM%` in the name of an
/// output may stand for. The error is one sentence.
pub fn refuse_twice(outputs: &[OutputFile], inputs: &[InputFile]) -> Result<(), String> {
    let mut writers: HashMap<FileId, &OutputFile> = HashMap::new();
    let is_conflict = |a: &OutputFile, b: &OutputFile| !(a.is_occasional && b.is_occasional);
    for output in outputs {
        match writers.insert(FileId::of(&tile_names::canonical(&output.path)), output) {
            Some(other) if is_conflict(other, output) => return Err(written_twice(other, output)),
            _ => {}
        }
    }
    let has_tiles = outputs.iter().any(|output| has_place(&output.path));
    let tile_of = |path: &Path| {
        let mut templates = has_tiles.then(|| tile_names::templates_of(path)).into_iter().flatten();
        templates.find_map(|template| writers.get(&FileId::of(&template)).copied())
    };
    let tile = outputs.iter().find_map(|output| {
        tile_of(&output.path).filter(|other| is_conflict(other, output)).map(|other| (other, output))
    });
    if let Some((other, output)) = tile {
        return Err(written_twice(other, output));
    }
    let writer = |path: &Path| writers.get(&FileId::of(path)).copied().or_else(|| tile_of(path));
    match inputs.iter().find_map(|input| Some((input, writer(&input.path)?))) {
        Some((InputFile { path, role }, output)) => {
            let alias = alias(&output.path, path);
            Err(format!("{}: would replace {role}{alias}; choose another name", output.path.display()))
        }
        None => Ok(()),
    }
}

fn written_twice(a: &OutputFile, b: &OutputFile) -> String {
    let alias = alias(&b.path, &a.path);
    let how = if a.bake == b.bake { "is named twice" } else { "is written by two bakes of the job" };
    format!("{}: {how}{alias}; choose another name", b.path.display())
}

/// Another name of a file, where it is written otherwise.
fn alias(path: &Path, other: &Path) -> String {
    match path.as_os_str() == other.as_os_str() {
        true => String::new(),
        false => format!(" ({})", other.display()),
    }
}

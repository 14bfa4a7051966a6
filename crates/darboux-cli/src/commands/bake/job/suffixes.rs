//! The pairs of a folder: NAME_low with NAME_high, NAME_high_bolts and so on, and the cage NAME_cage if there is one.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::entry::Entry;
use crate::commands::bake::arguments::BakeArguments;
use crate::options::messages::MessageOptions;

/// The models of a name.
#[derive(Default)]
struct Pair {
    low: Option<PathBuf>,
    high: Vec<PathBuf>,
    cage: Option<PathBuf>,
}

/// The entries, in the order of names: each with the options of the command line. Errors are one sentence each.
pub fn entries(arguments: &BakeArguments) -> Result<Vec<Entry>, String> {
    let folder = &arguments.low;
    let output = if arguments.output.as_os_str().is_empty() { folder } else { &arguments.output };
    if !output.is_dir() {
        return Err(format!("{}: is no folder; with --suffixes, -o names one that exists", output.display()));
    }
    let mut entries = Vec::new();
    for (name, pair) in pairs(folder)? {
        let (Some(low), [_, ..]) = (pair.low, &pair.high[..]) else { continue };
        let mut arguments = arguments.clone();
        arguments.low = low;
        arguments.high = pair.high;
        arguments.output = output.join(format!("{name}.png"));
        arguments.write_model = arguments.write_model.map(|_| output.join(format!("{name}.baked.glb")));
        arguments.report = arguments.report.map(|_| output.join(format!("{name}.report.html")));
        arguments.write_cage = arguments.write_cage.map(|_| output.join(format!("{name}.cage.glb")));
        if pair.cage.is_some() {
            (arguments.cage, arguments.cage_offset, arguments.distance) = (pair.cage, None, None);
            (arguments.auto_cage, arguments.offset_colors) = (None, false);
        }
        let options = format!("{:?}", without_messages(&arguments));
        entries.push(Entry { arguments, options });
    }
    match entries.is_empty() {
        true => Err(format!(
            "{}: has no pair of models; name them NAME_low.glb and NAME_high.glb",
            folder.display()
        )),
        false => Ok(entries),
    }
}

/// The arguments without what changes no output.
fn without_messages(arguments: &BakeArguments) -> BakeArguments {
    let messages = MessageOptions::default();
    BakeArguments { resume: false, force: false, jobs: None, messages, ..arguments.clone() }
}

fn pairs(folder: &Path) -> Result<BTreeMap<String, Pair>, String> {
    let failed = |error: std::io::Error| format!("{}: cannot be read: {error}", folder.display());
    let mut paths: Vec<PathBuf> = Vec::new();
    for file in fs::read_dir(folder).map_err(failed)? {
        paths.push(file.map_err(failed)?.path());
    }
    paths.sort();
    let mut pairs: BTreeMap<String, Pair> = BTreeMap::new();
    for path in paths.into_iter().filter(|path| is_model(path)) {
        let Some(stem) = path.file_stem().and_then(|stem| stem.to_str()) else { continue };
        let lower = stem.to_lowercase();
        let ends = [
            ("_low", lower.strip_suffix("_low").map(str::len)),
            ("_cage", lower.strip_suffix("_cage").map(str::len)),
            ("_high", lower.rfind("_high")),
        ];
        let Some((kind, end)) = ends.into_iter().find_map(|(kind, end)| Some((kind, end?))) else { continue };
        let pair = pairs.entry(lower[..end].to_owned()).or_default();
        match kind {
            "_low" => pair.low = Some(path),
            "_cage" => pair.cage = Some(path),
            _ => pair.high.push(path),
        }
    }
    Ok(pairs)
}

fn is_model(path: &Path) -> bool {
    let known = ["gltf", "glb", "vrm", "obj"];
    path.extension()
        .and_then(|extension| extension.to_str())
        .is_some_and(|extension| known.iter().any(|known| extension.eq_ignore_ascii_case(known)))
}

//! The pairs of a folder: NAME_low with NAME_high, NAME_high_bolts and so on, and the cage NAME_cage if there
//! is one. [`LOW_SUFFIXES`] and [`HIGH_SUFFIXES`] have the other suffixes.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, Command};
use darboux_bake::{HIGH_SUFFIXES, LOW_SUFFIXES, suffix_start};
use darboux_io::{FileKind, system_reason};

use super::entry::Entry;
use crate::commands::bake::arguments::BakeArguments;
use crate::commands::bake::encode;
use crate::options::given::Given;
use crate::options::messages::MessageOptions;

/// What stands for the name of a pair in the names of outputs.
const NAME: &str = "%NAME%";

/// The pairs of a folder, and what is unusual about the others.
pub struct Pairs {
    pub entries: Vec<Entry>,
    pub warnings: Vec<String>,
}

/// The models of a name.
#[derive(Default)]
struct Pair {
    low: Vec<PathBuf>,
    high: Vec<PathBuf>,
    cage: Vec<PathBuf>,
}

impl Pair {
    /// Two models that are the same part, such as an FBX and the GLB that was made from it, or NAME_high and
    /// NAME_hp.
    fn twice(&self) -> Option<[&PathBuf; 2]> {
        let only = |_: &Path| String::new();
        let of_high = first_equal(&self.high, detail_of);
        first_equal(&self.low, only).or(of_high).or_else(|| first_equal(&self.cage, only))
    }
}

/// The first file whose key another one before it has, and that one.
fn first_equal(files: &[PathBuf], key: impl Fn(&Path) -> String) -> Option<[&PathBuf; 2]> {
    let mut known = BTreeMap::new();
    files.iter().find_map(|file| known.insert(key(file), file).map(|other| [other, file]))
}

/// What follows the suffix in the name of a high model.
fn detail_of(path: &Path) -> String {
    let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default().to_lowercase();
    let start = suffix_start(&stem, &HIGH_SUFFIXES).unwrap_or_default();
    let after = HIGH_SUFFIXES.iter().filter_map(|suffix| stem[start..].strip_prefix(suffix));
    after.min_by_key(|detail| detail.len()).unwrap_or_default().to_owned()
}

/// Files that are named like the models of pairs, by name.
#[derive(Default)]
struct Found {
    pairs: BTreeMap<String, Pair>,
    /// Images that are named like low models.
    images: BTreeMap<String, PathBuf>,
}

/// The part of a pair that a file is.
#[derive(Clone, Copy)]
enum Part {
    Low,
    High,
    Cage,
}

/// The entries, in the order of names: each with the options of the command line. Errors are one sentence
/// each.
pub fn pairs(arguments: &BakeArguments) -> Result<Pairs, String> {
    refuse_named_models(arguments)?;
    let folder = &arguments.low;
    let Found { pairs, images } = find(folder)?;
    let (mut entries, mut warnings) = (Vec::new(), Vec::new());
    for (name, pair) in pairs {
        if let Some([first, second]) = pair.twice() {
            let (first, second) = (first.display(), second.display());
            return Err(format!(
                "{first} and {second} are the same part of one pair; move one of them to another folder"
            ));
        }
        match (pair.low.first(), pair.high.first()) {
            (Some(_), Some(_)) => {
                warnings.extend(without_effect(arguments, &pair));
                entries.push(entry(arguments, &name, pair)?);
            }
            (low, _) => warnings.extend(unpaired(&name, low, &pair, images.get(&name))),
        }
    }
    let missing = || {
        let hints: String = warnings.iter().map(|warning| format!("; {warning}")).collect();
        let shown = folder.display();
        format!("{shown}: has no pair of models; name them NAME_low.glb and NAME_high.glb{hints}")
    };
    if entries.is_empty() { Err(missing()) } else { Ok(Pairs { entries, warnings }) }
}

/// Refuses options that name one model: the folder has the models of all pairs.
fn refuse_named_models(arguments: &BakeArguments) -> Result<(), String> {
    let given = arguments.given.names(&BakeArguments::augment_args(Command::new("bake")));
    match given.iter().find(|name| ["high", "cage"].contains(&name.as_str())) {
        Some(name) => Err(format!("--{name} and --suffixes exclude each other: the names of files decide")),
        None => Ok(()),
    }
}

fn entry(job: &BakeArguments, name: &str, pair: Pair) -> Result<Entry, String> {
    let mut arguments = job.clone();
    arguments.low = pair.low.into_iter().next().unwrap_or_default();
    arguments.high = pair.high;
    arguments.makes_folders = true;
    arguments.map = job.completed_map();
    for (path, ending) in [
        (&mut arguments.write_model, "baked.glb"),
        (&mut arguments.report, "report.html"),
        (&mut arguments.write_cage, "cage.glb"),
        (&mut arguments.heat_map, "errors.png"),
        (&mut arguments.heat_model, "errors.glb"),
    ] {
        if let Some(given) = path {
            *given = in_folder(given, name, ending)?;
        }
    }
    arguments.output = image(job, name, arguments.write_model.as_deref())?;
    if let Some(cage) = pair.cage.into_iter().next() {
        (arguments.cage, arguments.distance) = (Some(cage), None);
        (arguments.auto_cage, arguments.offset_colors) = (None, false);
    }
    let options = format!("{:?}", without_messages(&arguments));
    Ok(Entry { arguments, options, place: None })
}

/// The image of a pair: by `-o`, or else beside its model, or else in the folder of the pairs.
fn image(job: &BakeArguments, name: &str, model: Option<&Path>) -> Result<PathBuf, String> {
    match (job.output.as_os_str().is_empty(), model) {
        (false, _) => in_folder(&job.output, name, "png"),
        (true, Some(model)) => Ok(model.with_extension("png")),
        (true, None) => Ok(job.low.join(format!("{name}.png"))),
    }
}

/// The output of a pair: the path with the name in it, or NAME and an ending in the folder of this path.
/// Errors: the path is that of a file.
fn in_folder(path: &Path, name: &str, ending: &str) -> Result<PathBuf, String> {
    if let Some(path) = with_name(path, name) {
        return Ok(path);
    }
    let file = format!("{name}.{ending}");
    let is_file = encode::FileKind::of(path).is_some() || path.extension() == Path::new(&file).extension();
    if is_file && !path.is_dir() {
        let path = path.display();
        return Err(format!("{path}: all pairs would write it; name a folder, or write {NAME} in the name"));
    }
    Ok(path.join(file))
}

fn with_name(path: &Path, name: &str) -> Option<PathBuf> {
    let text = path.to_str()?;
    text.contains(NAME).then(|| text.replace(NAME, name).into())
}

/// The arguments without what changes no output.
fn without_messages(arguments: &BakeArguments) -> BakeArguments {
    let messages = MessageOptions::default();
    let given = Given::default();
    BakeArguments {
        given,
        resume: false,
        retry: false,
        force: false,
        jobs: None,
        messages,
        ..arguments.clone()
    }
}

/// What is said about options that the cage of a pair overrules.
fn without_effect(job: &BakeArguments, pair: &Pair) -> Option<String> {
    let overruled = [
        ("--distance", job.distance.is_some()),
        ("--auto-cage", job.auto_cage.is_some()),
        ("--offset-colors", job.offset_colors),
    ];
    let cage = pair.cage.first()?.display();
    let (option, _) = overruled.into_iter().find(|(_, is_given)| *is_given)?;
    Some(format!("{cage}: is the cage of its pair, so that {option} is without effect there"))
}

/// What is said about models of which no pair can be made.
fn unpaired(name: &str, low: Option<&PathBuf>, pair: &Pair, image: Option<&PathBuf>) -> Vec<String> {
    let warning = |path: &PathBuf, missing: &str| {
        let image = image.filter(|_| low.is_none());
        let image = image.map(|image| format!(" ({} is an image)", image.display())).unwrap_or_default();
        format!("{}: is left out, because there is no model {name}{missing}{image}", path.display())
    };
    match low {
        Some(low) => vec![warning(low, "_high")],
        None => pair.high.iter().chain(&pair.cage).map(|path| warning(path, "_low")).collect(),
    }
}

fn find(folder: &Path) -> Result<Found, String> {
    let failed =
        |error: std::io::Error| format!("{}: cannot be read: {}", folder.display(), system_reason(&error));
    let mut paths: Vec<PathBuf> = Vec::new();
    for file in fs::read_dir(folder).map_err(failed)? {
        paths.push(file.map_err(failed)?.path());
    }
    paths.sort();
    let mut found = Found::default();
    for path in paths {
        let (Some(kind), Some((name, part))) = (FileKind::of(&path), part_of(&path)) else { continue };
        if kind.is_model() {
            let pair = found.pairs.entry(name).or_default();
            match part {
                Part::Low => pair.low.push(path),
                Part::High => pair.high.push(path),
                Part::Cage => pair.cage.push(path),
            }
        } else if kind.is_image() && matches!(part, Part::Low) {
            found.images.insert(name, path);
        }
    }
    Ok(found)
}

/// The name of a pair, and the part of it that a file is by its name.
fn part_of(path: &Path) -> Option<(String, Part)> {
    let stem = path.file_stem()?.to_str()?.to_lowercase();
    let end_of =
        |suffixes: &[&str]| suffixes.iter().find_map(|suffix| stem.strip_suffix(suffix)).map(str::len);
    let ends = [
        (Part::Low, end_of(&LOW_SUFFIXES)),
        (Part::Cage, end_of(&["_cage"])),
        (Part::High, suffix_start(&stem, &HIGH_SUFFIXES)),
    ];
    let (part, end) = ends.into_iter().find_map(|(part, end)| Some((part, end?)))?;
    Some((stem[..end].to_owned(), part))
}

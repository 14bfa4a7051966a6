//! Bakes the entries of a job.

use std::cell::{Cell, OnceCell};
use std::collections::HashSet;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

use darboux_io::RunId;
use serde::Serialize;

use super::entry::{Entry, Job};
use crate::batch::journal::{Earlier, Journal, OutputInputs, Record, skipped};
use crate::commands::bake::arguments::{BakeArguments, OwnOutputs};
use crate::commands::bake::conflicts::{InputFile, all_inputs, files_of, outputs_of, refuse_twice};
use crate::commands::bake::failure::BakeFailure;
use crate::commands::bake::outputs::{maps_of, named, refuse_existing};
use crate::commands::bake::report::{BakeReport, summary};
use crate::commands::bake::single::{bake_files, check_usage, progress_units};
use crate::commands::bake::skew::SkewChoice;
use crate::commands::bake::tile_names::has_place;
use crate::exit;
use crate::json::{VERSION, print_report};
use crate::memory::{self, JobMemory};
use crate::net;
use crate::options::files::new_run;
use crate::options::reading::ReadOptions;
use crate::terminal::Messages;
use crate::text::counted;

/// The JSON report of a job. json.txt documents its fields.
#[derive(Debug, Serialize)]
struct JobReport {
    command: &'static str,
    version: &'static str,
    bakes: Vec<BakeReport>,
    up_to_date: usize,
    errors: Vec<String>,
}

/// Bakes the entries and returns the exit code. An entry that fails does not stop the others.
pub fn run(arguments: &BakeArguments, Job { entries, warnings }: Job, messages: &Messages) -> u8 {
    warnings.iter().for_each(|warning| messages.warn(warning));
    if let Err(sentence) = check_entries(arguments, &entries) {
        messages.error(&sentence);
        return exit::USAGE;
    }
    print_entries(&entries, messages);
    let run = new_run();
    let journal = match arguments.resume.then(|| Journal::open(&folder_of(arguments), run)).transpose() {
        Ok(journal) => journal,
        Err(sentence) => {
            messages.error(&sentence);
            return exit::FAILED;
        }
    };
    let mut report =
        JobReport { command: "bake", version: VERSION, bakes: Vec::new(), up_to_date: 0, errors: Vec::new() };
    let _note = journal.as_ref().and_then(Journal::note_interrupts);
    messages.start(entries.iter().map(|entry| progress_units(&entry.arguments)).sum());
    let job = Work { arguments, journal: journal.as_ref(), run, messages, memory: JobMemory::available() };
    job.bake_all(&entries, &mut |done| match done {
        Ok(Some(baked)) => {
            print_baked(&baked, messages);
            report.bakes.push(baked);
        }
        Ok(None) => report.up_to_date += 1,
        Err(sentence) => {
            messages.error(&sentence);
            report.errors.push(sentence);
        }
    });
    messages.end_progress();
    messages.say(&totals(&report));
    let code = print_report(&report, arguments.messages.json, messages);
    if report.errors.is_empty() { code } else { exit::FAILED }
}

/// The folder of a job, which has its journal.
pub fn folder_of(arguments: &BakeArguments) -> PathBuf {
    let low = &arguments.low;
    let parent = || low.parent().filter(|folder| !folder.as_os_str().is_empty());
    if low.is_dir() { low.clone() } else { parent().unwrap_or(Path::new(".")).to_owned() }
}

/// Refuses, before anything is baked, entries that cannot be right, and files that two of them would write.
pub fn check_entries(job: &BakeArguments, entries: &[Entry]) -> Result<(), String> {
    let (mut outputs, mut inputs) =
        (Vec::new(), vec![InputFile { path: job.low.clone(), role: "the job".to_owned() }]);
    for (number, Entry { arguments, place, .. }) in entries.iter().enumerate() {
        let mut checked = arguments.clone();
        checked.force |= job.resume;
        check_usage(&checked).map_err(|problem| match place {
            Some(place) => format!("{place}: {problem}"),
            None => problem,
        })?;
        outputs.extend(outputs_of(arguments, number));
        inputs.extend(all_inputs(arguments));
    }
    refuse_twice(&outputs, &inputs)?;
    // A file that does not exist is no part of a model.
    if outputs.iter().any(|output| output.path.exists()) {
        inputs.extend(files_of_models(entries));
    }
    refuse_twice(&outputs, &inputs)
}

/// The files that the models of a job refer to. A model that cannot be opened fails where it is baked.
fn files_of_models(entries: &[Entry]) -> Vec<InputFile> {
    let mut opened = HashSet::new();
    let models = entries.iter().flat_map(|Entry { arguments, .. }| {
        let BakeArguments { low, high, cage, reading, .. } = arguments;
        [low].into_iter().chain(high).chain(cage).map(move |path| (path, reading))
    });
    let models = models.filter(|(path, _)| opened.insert(*path));
    let files = |(path, reading): (&PathBuf, &ReadOptions)| {
        let opened = net::catch(&path.display(), || reading.open(path).map_err(|error| error.to_string()));
        opened.map(|document| files_of(&document)).unwrap_or_default()
    };
    models.flat_map(files).collect()
}

fn print_entries(entries: &[Entry], messages: &Messages) {
    for Entry { arguments, .. } in entries {
        let BakeArguments { low, high, cage, .. } = arguments;
        let high: Vec<String> = high.iter().map(|path| path.display().to_string()).collect();
        let cage = cage.as_ref().map(|cage| format!(", cage {}", cage.display())).unwrap_or_default();
        let outputs = shown_outputs(arguments);
        messages.say(&format!("{} from {}{cage}: {outputs}", low.display(), high.join(", ")));
    }
}

/// The model that an entry writes, and its images: as a pattern where there are several.
fn shown_outputs(arguments: &BakeArguments) -> String {
    let images = match &maps_of(arguments)[..] {
        [(_, image)] if arguments.pack.is_empty() => image.display().to_string(),
        _ => named(arguments, "*").display().to_string(),
    };
    let model = arguments.write_model.as_ref().map(|model| format!("{}, ", model.display()));
    model.unwrap_or_default() + &images
}

/// The report of an entry; none if an earlier run has done it. Errors are one sentence each.
type Done = Result<Option<BakeReport>, String>;

/// What the work on all entries shares.
struct Work<'a> {
    arguments: &'a BakeArguments,
    journal: Option<&'a Journal>,
    run: RunId,
    messages: &'a Messages,
    memory: JobMemory,
}

impl Work<'_> {
    /// Bakes all entries, several at once: their threads share one pool, and one reads or writes files while
    /// another follows rays. Entries at which an earlier run was killed come last, one by one. `tell` is
    /// called in the order of the entries.
    fn bake_all(&self, entries: &[Entry], tell: &mut dyn FnMut(Done)) {
        let next = AtomicUsize::new(0);
        let (together, alone): (Vec<usize>, Vec<usize>) =
            (0..entries.len()).partition(|&index| self.earlier(&entries[index]) == Earlier::Harmless);
        let bake_next = || {
            let index = *together.get(next.fetch_add(1, Ordering::Relaxed))?;
            Some((index, self.bake(&entries[index])))
        };
        let mut finished: Vec<Option<Done>> = entries.iter().map(|_| None).collect();
        let mut told = 0;
        let mut add = |(index, done): (usize, Done)| {
            finished[index] = Some(done);
            while let Some(done) = finished.get_mut(told).and_then(Option::take) {
                tell(done);
                told += 1;
            }
        };
        let cores = || thread::available_parallelism().map_or(1, NonZero::get);
        let workers = self.arguments.jobs.map_or_else(cores, |jobs| usize::from(jobs.get()));
        thread::scope(|scope| {
            let (sender, receiver) = mpsc::channel();
            for _ in 1..workers.min(together.len()) {
                let (sender, bake_next) = (sender.clone(), &bake_next);
                let work = move || while bake_next().is_some_and(|done| sender.send(done).is_ok()) {};
                if thread::Builder::new().spawn_scoped(scope, work).is_err() {
                    break;
                }
            }
            drop(sender);
            while let Some(done) = bake_next() {
                add(done);
                receiver.try_iter().for_each(&mut add);
            }
            receiver.iter().for_each(&mut add);
            for index in alone {
                add((index, self.bake(&entries[index])));
            }
        });
    }

    /// What earlier runs say about an entry.
    fn earlier(&self, entry: &Entry) -> Earlier {
        self.journal.map_or(Earlier::Harmless, |journal| journal.earlier(&entry.arguments.output))
    }

    fn bake(&self, entry: &Entry) -> Done {
        let recorded = self.journal.map(|journal| Recorded::of(journal, entry));
        let arguments = arguments_of(entry, recorded)?;
        let bake = |limit| bake_entry(&arguments, &entry.options, recorded, self.run, limit, self.messages);
        self.caught(entry, bake)
    }

    /// Bakes an entry within a share of the memory, and writes the journal. A panic fails this entry alone.
    fn caught(&self, entry: &Entry, bake: impl Fn(Option<u64>) -> Result<BakedEntry, BakeFailure>) -> Done {
        let BakeArguments { low, output, .. } = &entry.arguments;
        let estimate = OnceCell::new();
        let estimate = || *estimate.get_or_init(|| BakeMemory::of(&entry.arguments));
        let share = Cell::new(Some(self.memory.wait_for(|| estimate().whole())));
        let within_share = || {
            let Some(mine) = share.take() else { return bake(None) };
            if mine.is_whole() {
                let done = bake(mine.limit());
                share.set(Some(mine));
                return done;
            }
            let done = bake(Some(estimate().beside_models()));
            if !matches!(done, Err(BakeFailure::Memory(_))) {
                share.set(Some(mine));
                return done;
            }
            // The estimate was too small: alone, it may use all memory.
            drop(mine);
            let whole = self.memory.wait_for(|| u64::MAX);
            let done = bake(whole.limit());
            share.set(Some(whole));
            done
        };
        let work = || match net::catch(&low.display(), || within_share().map_err(String::from)) {
            Ok(BakedEntry { report, record }) => (Ok(report), record),
            Err(sentence) => (Err(sentence), None),
        };
        match self.journal {
            None => work().0,
            Some(journal) => {
                let done = journal.around(output, self.arguments.retry, work)?;
                done.unwrap_or_else(|| Err(skipped(&low.display())))
            }
        }
    }
}

/// The bytes that a bake needs, about.
#[derive(Clone, Copy)]
struct BakeMemory {
    /// Its models, and the hierarchies over them.
    models: u64,
    /// Its images while they are made, which have up to four channels per map.
    maps: u64,
}

impl BakeMemory {
    fn of(arguments: &BakeArguments) -> Self {
        let BakeArguments { low, high, cage, size, report, reading, .. } = arguments;
        let options = reading.load_options();
        // Pages draw all models with their textures. Where images are not decoded, they are counted in the
        // bytes.
        let draws_textures = report.is_some();
        let high = high
            .iter()
            .map(|path| memory::of_model(path, &options, draws_textures || arguments.reads_textures()));
        let low = memory::of_model(low, &options, draws_textures);
        let cage = cage.iter().map(|path| memory::of_model(path, &options, false));
        let models = high.chain([low]).chain(cage).fold(0, u64::saturating_add);
        let texels = u64::from(size[0]) * u64::from(size[1]);
        let maps = texels * (64 + 24 * arguments.baked_maps().kinds().count() as u64);
        Self { models, maps }
    }

    /// All of it.
    fn whole(self) -> u64 {
        self.models.saturating_add(self.maps)
    }

    /// What the bake may use beside its models, once they are read. A hierarchy takes 100 bytes per triangle,
    /// less than half of what the estimate has for three corners and the bytes of the file.
    fn beside_models(self) -> u64 {
        self.maps.saturating_add(self.models / 2)
    }
}

/// What a journal says about an entry.
#[derive(Clone, Copy)]
pub struct Recorded<'a> {
    pub folder: &'a Path,
    /// Of the entry's output.
    pub record: Option<&'a Record>,
    /// Whether an earlier run may have written the outputs without leaving a record.
    pub may_have_written: bool,
}

impl<'a> Recorded<'a> {
    fn of(journal: &'a Journal, entry: &Entry) -> Self {
        let output = &entry.arguments.output;
        let may_have_written = journal.may_have_written(output);
        Self { folder: journal.folder(), record: journal.find(output), may_have_written }
    }

    /// The files that the entry may replace.
    fn own_outputs(&self) -> OwnOutputs {
        match self.record {
            _ if self.may_have_written => OwnOutputs::All,
            Some(record) => OwnOutputs::Files(record.files(self.folder)),
            None => OwnOutputs::Files(Vec::new()),
        }
    }
}

/// The result of an entry.
pub struct BakedEntry {
    /// None if an earlier run has done it.
    pub report: Option<BakeReport>,
    /// What the journal gets.
    pub record: Option<Record>,
}

/// The arguments of an entry. `recorded`: none without `--resume`. Errors: an output that no run has written.
pub fn arguments_of(entry: &Entry, recorded: Option<Recorded<'_>>) -> Result<BakeArguments, String> {
    let mut arguments = entry.arguments.clone();
    if let Some(recorded) = recorded {
        arguments.own_outputs = recorded.own_outputs();
        // Tiles are known when the low model was read.
        if !has_place(&arguments.output) {
            refuse_existing(&arguments)?;
        }
    }
    Ok(arguments)
}

/// Bakes an entry, unless an earlier run has done it. `arguments`: of [`arguments_of`]; `recorded`: none
/// without `--resume`; `memory`: as the share of [`bake_files`].
pub fn bake_entry(
    arguments: &BakeArguments,
    options: &str,
    recorded: Option<Recorded<'_>>,
    run: RunId,
    memory: Option<u64>,
    messages: &Messages,
) -> Result<BakedEntry, BakeFailure> {
    let Some(Recorded { folder, record, .. }) = recorded else {
        let report = bake_files(arguments, None, memory, messages)?;
        return Ok(BakedEntry { report: Some(report), record: None });
    };
    let inputs = inputs_of(arguments, options.to_owned())?;
    if record.is_some_and(|record| record.is_up_to_date(&inputs, folder)) {
        return Ok(BakedEntry { report: None, record: None });
    }
    let report = bake_files(arguments, Some(run), memory, messages)?;
    let record = Record::new(folder, &arguments.output, inputs, &report.files(), &report)?;
    Ok(BakedEntry { report: Some(report), record })
}

fn print_baked(report: &BakeReport, messages: &Messages) {
    // A job has many bakes, and most sentences name no file.
    for warning in &report.warnings {
        match warning.starts_with(&report.low) {
            true => messages.warn(warning),
            false => messages.warn(&format!("{}: {warning}", report.low)),
        }
    }
    summary(report).iter().for_each(|line| messages.say(line));
}

/// Everything that the outputs of an entry depend on. Errors: a file cannot be read.
fn inputs_of(arguments: &BakeArguments, options: String) -> Result<OutputInputs, String> {
    let skew = match &arguments.skew {
        Some(SkewChoice::Image(path)) => Some(path),
        _ => None,
    };
    let others = arguments.high.iter().chain(&arguments.cage).chain(skew);
    let others = others.map(|path| OutputInputs::new("bake", String::new(), path, &arguments.reading));
    let others: Vec<OutputInputs> = others.collect::<Result<_, _>>()?;
    let options = serde_json::to_string(&(options, others)).map_err(|error| error.to_string())?;
    OutputInputs::new("bake", options, &arguments.low, &arguments.reading)
}

fn totals(report: &JobReport) -> String {
    let mut parts = vec![counted(report.bakes.len(), "bake is done", "bakes are done")];
    if report.up_to_date > 0 {
        parts.push(counted(report.up_to_date, "was up to date", "were up to date"));
    }
    if !report.errors.is_empty() {
        parts.push(counted(report.errors.len(), "has failed", "have failed"));
    }
    parts.join(", ")
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::commands::bake::job::file;

    #[test]
    fn a_panic_fails_one_bake() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("job.toml");
        let entry = |name: &str| {
            format!("[[bake]]\nlow = \"{name}.glb\"\nhigh = \"high.glb\"\noutput = \"{name}.png\"\n")
        };
        fs::write(&path, entry("a") + &entry("b")).unwrap();
        let entries = file::entries(&path).unwrap();
        let run = new_run();
        let journal = Journal::open(folder.path(), run).unwrap();
        let (arguments, messages) = (&entries[0].arguments, &Messages::new(true));
        let work = Work { arguments, journal: Some(&journal), run, messages, memory: JobMemory::available() };
        let sentence = work.caught(&entries[0], |_| panic!("no such row")).unwrap_err();
        assert!(sentence.contains("a.glb: darboux failed on this file: no such row; this is"), "{sentence}");
        let next = work.caught(&entries[1], |_| Ok(BakedEntry { report: None, record: None }));
        assert!(next.unwrap().is_none());
        // The run was not killed, so the next one tries it again with the others.
        drop(journal);
        let journal = Journal::open(folder.path(), new_run()).unwrap();
        assert_eq!(journal.earlier(&entries[0].arguments.output), Earlier::Harmless);
    }

    /// The images of the low model are not decoded; the images of the high model are decoded only where a map
    /// needs them.
    #[test]
    fn models_and_maps_are_counted_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("job.toml");
        fs::write(folder.path().join("m.gltf"), r#"{"images":[{"uri":"a.png"}]}"#).unwrap();
        let entry = |more: &str| {
            format!("[[bake]]\nlow = \"m.gltf\"\nhigh = \"m.gltf\"\noutput = \"a.png\"\nsize = 16\n{more}\n")
        };
        let memory_of = |more: &str| {
            fs::write(&path, entry(more)).unwrap();
            BakeMemory::of(&file::entries(&path).unwrap()[0].arguments)
        };
        let mebibytes = |bytes: u64| bytes >> 20;
        let decoded = memory_of("");
        assert_eq!(mebibytes(decoded.whole()), 256 + 16);
        assert_eq!(mebibytes(memory_of("no-high-maps = true").whole()), 16 + 16);
        let colors = "no-high-maps = true\nmap = [\"base-color\"]";
        assert_eq!(mebibytes(memory_of(colors).whole()), 256 + 16);
        assert_eq!(mebibytes(decoded.beside_models()), (256 + 16) / 2);
    }
}

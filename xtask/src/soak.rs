//! `cargo xtask soak`: runs the command on damaged and hostile files, for as long as wanted, and checks what
//! every run must keep.
//!
//! Each case is an empty folder with a few files and a command line. Most are models and images of every
//! format with a few damaged bytes or values; directed cases try one kind of defect each. A run must end by
//! itself with the right exit code, within limits of time and memory, with clean messages; inputs stay as
//! they were, nothing is left behind, and every output can be read again. A case is made from the seed
//! and its number alone, so that it can be repeated; only the moment of a signal and the order of processes
//! differ.

mod case;
mod child;
mod command_lines;
mod directed;
mod inputs;
mod options;
mod program;
mod random;
mod report;
mod runner;
mod tree;
mod verdict;
mod view;

use std::fs;
use std::path::PathBuf;

use crate::run::{Outcome, target_folder};
use case::{Action, Case};
use command_lines::{Commands, Files};
use directed::Directed;
use inputs::model::Mesh;
use inputs::mutate;
use inputs::seeds::{self, Seed};
use options::Options;
use program::Program;
use random::Random;
use report::Report;

/// Everything that cases are made from.
struct Soak {
    options: Options,
    program: Program,
    commands: Commands,
    seeds: Vec<Seed>,
    directed: Vec<Directed>,
    renders: bool,
    /// Where cases run.
    folder: PathBuf,
}

/// How often `--only` repeats a directed case: with other sizes and options each time.
const REPETITIONS: u64 = 8;

/// From this number on all cases are directed ones.
const DIRECTED: u64 = 1 << 32;

/// Errors: a wrong option; what the soak itself needs is refused by the system; a promise was broken.
pub fn run(words: &[&str]) -> Outcome {
    let options = Options::parse(words)?;
    let base = target_folder()?.join("soak");
    let keep = options.keep.clone().unwrap_or_else(|| base.join("broken"));
    let commands = Commands::read()?;
    let program = Program::find(options.program.as_deref(), commands.names().chain(["view"]))?;
    let renders = program.can_render();
    let seeds = seeds::all(options.models.as_deref())?;
    let folder = base.join(std::process::id().to_string());
    child::end_with_signals(folder.clone()).map_err(|error| format!("signals cannot be handled: {error}"))?;
    let soak = Soak { options, program, commands, seeds, directed: directed::all(), renders, folder };
    let mut report = Report::new(soak.options.duration, keep);
    println!(
        "{} on {} files and {} kinds of directed cases, seed {}; {}",
        soak.program.path.display(),
        soak.seeds.len(),
        soak.directed.len(),
        soak.options.seed,
        if soak.renders { "with pictures" } else { "without pictures: no adapter, or no subcommand render" }
    );
    let result = soak.run_all(&mut report);
    let _nothing_was_run = fs::remove_dir_all(&soak.folder);
    report.summary();
    result?;
    match report.broken() {
        0 => Ok(()),
        count => Err(format!("{count} broken promises; the cases are in {}", report.kept_in().display())),
    }
}

impl Soak {
    fn run_all(&self, report: &mut Report) -> Outcome {
        if let Some(number) = self.options.case {
            return self.run_case(number, report);
        }
        if let Some(word) = &self.options.only {
            let count = self.directed.len() as u64;
            let mut numbers = (DIRECTED..DIRECTED + REPETITIONS * count)
                .filter(|number| self.directed_of(*number).name.contains(word.as_str()));
            return numbers.try_for_each(|number| self.run_case(number, report));
        }
        let is_over = |number: u64, report: &Report| {
            self.options.cases.map_or_else(|| report.is_over(), |cases| number >= cases)
        };
        let mut number = 0;
        while !is_over(number, report) {
            self.run_case(number, report)?;
            report.progress();
            number += 1;
        }
        Ok(())
    }

    fn run_case(&self, number: u64, report: &mut Report) -> Outcome {
        let mut random = Random::new(self.options.seed, number);
        let Some(case) = self.case(number, &mut random)? else { return Ok(()) };
        let outcome = runner::run(&self.program, &case, &mut random, &self.folder)
            .map_err(|error| format!("case {number}, {}: {error}", case.name))?;
        report.add(
            &case,
            number,
            &outcome,
            &format!("cargo xtask soak --seed {} --case {number}", self.options.seed),
        )
    }

    /// The directed case with this number, which runs through the list again and again.
    fn directed_of(&self, number: u64) -> &Directed {
        &self.directed[number as usize % self.directed.len()]
    }

    /// The case with a number: first every directed case, then mostly damaged files. `None` if this program
    /// cannot run it.
    fn case(&self, number: u64, random: &mut Random) -> Result<Option<Case>, String> {
        if number < self.directed.len() as u64 || number >= DIRECTED {
            return self.directed_case(self.directed_of(number), random).transpose();
        }
        match random.below(100) {
            0..4 => {
                let directed = &self.directed[random.below(self.directed.len())];
                self.directed_case(directed, random).transpose()
            }
            4..7 if self.program.has("view", "") => Ok(Some(self.view(random))),
            _ => Ok(Some(self.damaged(random))),
        }
    }

    fn directed_case(&self, directed: &Directed, random: &mut Random) -> Option<Result<Case, String>> {
        if directed.renders && !self.renders {
            return None;
        }
        let case = (directed.make)(random);
        Some(case.map(|case| Case { name: directed.name.to_owned(), ..case }))
    }

    /// A file of any format: each is as frequent as the others, though most seeds are GLB files; these come
    /// twice as often.
    fn seed(&self, random: &mut Random) -> &Seed {
        let mut kinds: Vec<String> = self.seeds.iter().map(Seed::extension).collect();
        kinds.sort();
        kinds.dedup();
        kinds.push("glb".into());
        let kind = &kinds[random.below(kinds.len())];
        let seeds: Vec<&Seed> = self.seeds.iter().filter(|seed| seed.extension() == *kind).collect();
        seeds[random.below(seeds.len())]
    }

    /// A damaged file, or a good one beside a damaged companion, under any subcommand that reads it.
    fn damaged(&self, random: &mut Random) -> Case {
        let seed = self.seed(random);
        let extension = seed.extension();
        let (bytes, companions) = damage(random, seed);
        let file = format!("in.{extension}");
        let files = Files { file: &file, extension: &extension, other: "other.glb", renders: self.renders };
        let line = self.commands.any(random, &self.program, &files);
        // Random options may contradict each other.
        let mut case = Case::new(line.words).expects(&[0, 1, 2], "");
        case.name = format!("damaged {extension}");
        if line.reads_stdin {
            case.stdin = bytes;
        } else {
            case = case.file(format!("in.{extension}"), bytes);
        }
        if case.has("other.glb") {
            let other = if random.one_in(2) { Mesh::grid(8).glb() } else { seed.bytes.clone() };
            case = case.file("other.glb", other);
        }
        companions.into_iter().fold(case, |case, (name, bytes)| case.file(name, bytes))
    }

    /// The viewer on a damaged model, under hostile connections.
    fn view(&self, random: &mut Random) -> Case {
        let models: Vec<&Seed> =
            self.seeds.iter().filter(|seed| !command_lines::is_image(&seed.extension())).collect();
        let seed = models[random.below(models.len())];
        let name = format!("in.{}", seed.extension());
        let (bytes, companions) = if random.one_in(2) {
            (seed.bytes.clone(), seed.companions.clone())
        } else {
            damage(random, seed)
        };
        let mut case = Case::new(["view", "--no-open", "--page", "page", &name]).with_action(Action::View);
        case.name = "the viewer under hostile connections".into();
        case = case.file(name, bytes).file("page/index.html", "the page");
        companions.into_iter().fold(case, |case, (name, bytes)| case.file(name, bytes))
    }
}

/// A file and those beside it, one of them damaged.
fn damage(random: &mut Random, seed: &Seed) -> (Vec<u8>, Vec<(PathBuf, Vec<u8>)>) {
    let (mut bytes, mut companions) = (seed.bytes.clone(), seed.companions.clone());
    match companions.len() {
        0 => mutate::file(random, &seed.extension(), &mut bytes),
        count if random.one_in(3) => {
            let (name, bytes) = &mut companions[random.below(count)];
            let extension = name.extension().unwrap_or_default().to_string_lossy().into_owned();
            mutate::file(random, &extension, bytes);
        }
        _ => mutate::file(random, &seed.extension(), &mut bytes),
    }
    (bytes, companions)
}

//! Judges generated normal maps: prints how often the verdicts are right, or writes the page about it.
//! `--help` lists the options.

use std::path::PathBuf;
use std::process::ExitCode;

use darboux_tests::maps::outcome::MapSet;
use darboux_tests::maps::page::{Judged, page};
use darboux_tests::maps::table::failures;
use darboux_tests::maps::truth::Truth;

const HELP: &str = "\
Judges generated normal maps and prints how often the verdicts are right, and how sure they were.

  --count N          fields, each with green up and green down; every tenth also as maps that are no gradient (default: 2000)
  --first N          the number of the first field, and so its seed (default: 0, as on the page)
  --gentle N         nearly flat fields, on which the confidence is tested (default: 1000)
  --largest-side N   (default: 4096)
  --threads N        (default: one per core)
  --known            leave out the maps whose verdicts are not in the results yet
  --results FOLDER   keep the verdicts there; a run that was stopped goes on where it was (default: target/maps)
  --page FILE        write the page there";

struct Arguments {
    count: u64,
    first: u64,
    gentle: u64,
    largest_side: usize,
    threads: usize,
    is_known_only: bool,
    results: PathBuf,
    page: Option<PathBuf>,
}

fn main() -> ExitCode {
    let done = Arguments::parse(std::env::args().skip(1)).and_then(|arguments| match arguments {
        Some(arguments) => run(&arguments),
        None => {
            println!("{HELP}");
            Ok(())
        }
    });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(sentence) => {
            eprintln!("{sentence}");
            ExitCode::FAILURE
        }
    }
}

impl Arguments {
    /// None where help is asked for.
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Option<Self>, String> {
        let mut arguments = Self {
            count: 2000,
            first: 0,
            gentle: 1000,
            largest_side: 4096,
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            is_known_only: false,
            results: PathBuf::from("target/maps"),
            page: None,
        };
        while let Some(word) = words.next() {
            if word == "--help" {
                return Ok(None);
            }
            if word == "--known" {
                arguments.is_known_only = true;
                continue;
            }
            let value = words.next().ok_or_else(|| format!("{word} needs a value"))?;
            let number = || value.parse::<u64>().map_err(|_| format!("{word}: {value} is no number"));
            match word.as_str() {
                "--count" => arguments.count = number()?,
                "--first" => arguments.first = number()?,
                "--gentle" => arguments.gentle = number()?,
                "--largest-side" => arguments.largest_side = number()? as usize,
                "--threads" => arguments.threads = number()?.max(1) as usize,
                "--results" => arguments.results = PathBuf::from(value),
                "--page" => arguments.page = Some(PathBuf::from(value)),
                _ => return Err(format!("{word} is no option; --help lists them")),
            }
        }
        Ok(Some(arguments))
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    let regular = MapSet { largest_side: arguments.largest_side, slope: 1.0 };
    let gentle = MapSet { largest_side: arguments.largest_side.min(512), slope: 0.03 };
    let regular = judged(arguments, "regular", regular, arguments.first..arguments.first + arguments.count)?;
    // Other seeds than those of the regular maps.
    let first = 1_000_000 + arguments.first;
    let gentle = judged(arguments, "gentle", gentle, first..first + arguments.gentle)?;
    let text = page(&regular, &gentle);
    match &arguments.page {
        Some(path) => {
            std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        }
        None => println!("{text}"),
    }
    print!("{}", failures(&regular.set, &regular.outcomes));
    Ok(())
}

/// Judges the cases of these numbers with green up and down; every tenth one of the regular set also as maps
/// that are no gradient.
fn judged(
    arguments: &Arguments,
    name: &str,
    set: MapSet,
    numbers: std::ops::Range<u64>,
) -> Result<Judged, String> {
    let gradients = Truth::ALL[..2].to_vec();
    let mut cases: Vec<(u64, Vec<Truth>)> =
        numbers.clone().map(|number| (number, gradients.clone())).collect();
    let fail = |error: std::io::Error| format!("{name}: {error}");
    std::fs::create_dir_all(&arguments.results).map_err(fail)?;
    let file = |name: &str| arguments.results.join(format!("{name}.csv"));
    // The smallest maps first, so that most of the table is there soon.
    cases.sort_by_key(|(number, _)| set.case(*number).side);
    let judge = |set: MapSet, file: PathBuf, mut cases: Vec<(u64, Vec<Truth>)>| {
        if arguments.is_known_only {
            let known = set.known(&file)?;
            cases.retain(|(number, _)| known.iter().any(|outcome| outcome.number == *number));
        }
        set.judge_into(&file, &cases, arguments.threads)
    };
    let mut outcomes = judge(set, file(name), cases).map_err(fail)?;
    if set.slope == 1.0 {
        let small = MapSet { largest_side: set.largest_side.min(512), ..set };
        let cases: Vec<_> = numbers.step_by(10).map(|number| (number, Truth::ALL[2..].to_vec())).collect();
        let others = judge(small, file("no-gradient"), cases).map_err(fail)?;
        outcomes.extend(others);
    }
    Ok(Judged { set, outcomes })
}

//! [`Outcome`]: the verdict on one generated map, as a line of a results file; and the loop that judges many
//! maps.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Error, ErrorKind, Write};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use darboux::{MapVerdict, TexelLayout, judge_normal_map};

use super::truth::Truth;
use super::{MapCase, Relief};

/// Which maps are generated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSet {
    /// The largest side.
    pub largest_side: usize,
    /// What all slopes are multiplied with; 0.03 gives maps of about one code.
    pub slope: f32,
}

/// The verdict on one generated map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// The number of the case.
    pub number: u64,
    /// What the map is.
    pub truth: Truth,
    /// The verdict.
    pub verdict: MapVerdict,
    /// The stated confidence.
    pub confidence: f32,
    /// The z score.
    pub z_score: f32,
    /// Half the logarithm of the energy of unmixed over mixed derivatives.
    pub log_energy_ratio: f32,
}

const VERDICTS: [MapVerdict; 5] = [
    MapVerdict::OpenGl,
    MapVerdict::DirectX,
    MapVerdict::NoGradient,
    MapVerdict::Flat,
    MapVerdict::CannotTell,
];

/// How a verdict compares with the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Success {
    /// The right verdict.
    Right,
    /// A wrong one.
    Wrong,
    /// None.
    Undecided,
}

impl MapSet {
    /// The case of a number.
    pub fn case(&self, number: u64) -> MapCase {
        let mut case = MapCase::new(number, self.largest_side);
        case.slope *= self.slope;
        case
    }

    /// Judges cases as maps of several kinds on `threads` threads. `done` gets all outcomes of a case at
    /// once, in any order of cases.
    pub fn judge(&self, cases: &[(u64, Vec<Truth>)], threads: usize, done: &(dyn Fn(Vec<Outcome>) + Sync)) {
        let next = AtomicUsize::new(0);
        let work = || {
            while let Some((number, truths)) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                let case = self.case(*number);
                let relief = case.relief();
                done(truths.iter().map(|&truth| Outcome::of(*number, truth, &relief)).collect());
            }
        };
        std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    }

    /// As [`Self::judge`]; the outcomes in the order of the cases.
    pub fn judge_all(&self, cases: &[(u64, Vec<Truth>)], threads: usize) -> Vec<Outcome> {
        let outcomes = Mutex::new(Vec::new());
        self.judge(cases, threads, &|new| outcomes.lock().expect("no thread panicked").extend(new));
        let mut outcomes = outcomes.into_inner().expect("no thread panicked");
        outcomes.sort_by_key(|outcome: &Outcome| (outcome.number, outcome.truth as u8));
        outcomes
    }

    /// As [`Self::judge_all`], but outcomes that `file` holds are read from it, and new ones are appended to
    /// it, so that a run that was stopped goes on where it was. Errors: `file` cannot be read or written,
    /// or was made for another set.
    pub fn judge_into(
        &self,
        file: &Path,
        cases: &[(u64, Vec<Truth>)],
        threads: usize,
    ) -> Result<Vec<Outcome>, Error> {
        let (mut outcomes, appended) = self.open(file)?;
        let is_known = |number: u64, truth: Truth| {
            outcomes.iter().any(|outcome: &Outcome| (outcome.number, outcome.truth) == (number, truth))
        };
        let missing: Vec<(u64, Vec<Truth>)> = cases
            .iter()
            .map(|(number, truths)| {
                (*number, truths.iter().copied().filter(|&truth| !is_known(*number, truth)).collect())
            })
            .filter(|(_, truths): &(u64, Vec<Truth>)| !truths.is_empty())
            .collect();
        let results = Mutex::new((Vec::new(), Ok(()), appended));
        self.judge(&missing, threads, &|new| {
            let mut results = results.lock().expect("no thread panicked");
            let lines: String = new.iter().map(|outcome| format!("{}\n", outcome.line())).collect();
            let written = results.2.write_all(lines.as_bytes());
            results.1 = std::mem::replace(&mut results.1, Ok(())).and(written);
            results.0.extend(new);
        });
        let (new, written, _) = results.into_inner().expect("no thread panicked");
        written?;
        outcomes.extend(new);
        outcomes.retain(|outcome| {
            cases.iter().any(|(number, truths)| *number == outcome.number && truths.contains(&outcome.truth))
        });
        outcomes.sort_by_key(|outcome| (outcome.number, outcome.truth as u8));
        Ok(outcomes)
    }

    /// The outcomes that `file` holds. Errors: as [`Self::judge_into`].
    pub fn known(&self, file: &Path) -> Result<Vec<Outcome>, Error> {
        self.open(file).map(|(outcomes, _)| outcomes)
    }

    /// The first line of a results file.
    fn header(&self) -> String {
        format!("sides up to {}, slopes times {}", self.largest_side, self.slope)
    }

    /// The outcomes in a file, and the file for further ones. A last line that was not written whole is
    /// dropped.
    fn open(&self, path: &Path) -> Result<(Vec<Outcome>, File), Error> {
        let mut lines = match File::open(path) {
            Ok(file) => BufReader::new(file).lines().collect::<Result<Vec<_>, _>>()?,
            Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
            Err(error) => return Err(error),
        };
        if lines.is_empty() {
            lines.push(self.header());
        }
        if lines[0] != self.header() {
            let sentence = format!("{} holds results for other maps; remove it", path.display());
            return Err(Error::new(ErrorKind::InvalidData, sentence));
        }
        let outcomes: Vec<Outcome> = lines[1..].iter().filter_map(|line| Outcome::from_line(line)).collect();
        let text: String = outcomes.iter().map(|outcome| format!("{}\n", outcome.line())).collect();
        std::fs::write(path, format!("{}\n{text}", self.header()))?;
        Ok((outcomes, OpenOptions::new().append(true).open(path)?))
    }
}

impl Outcome {
    fn of(number: u64, truth: Truth, relief: &Relief<'_>) -> Self {
        let side = relief.case().side;
        let judged = judge_normal_map(&truth.texels_of(relief), [side; 2], TexelLayout::RGB);
        let judgement = judged.expect("the map is whole");
        Self {
            number,
            truth,
            verdict: judgement.verdict,
            confidence: judgement.confidence,
            z_score: judgement.z_score,
            log_energy_ratio: judgement.log_energy_ratio,
        }
    }

    /// How the verdict compares with the truth.
    pub fn success(&self) -> Success {
        match self.verdict {
            verdict if verdict == self.truth.verdict() => Success::Right,
            MapVerdict::CannotTell => Success::Undecided,
            _ => Success::Wrong,
        }
    }

    /// Whether the sign of the z score is that of green. None for maps without a green direction, and where
    /// the confidence is not that of a sign.
    pub fn has_right_sign(&self) -> Option<bool> {
        let green = self.truth.green()?;
        let is_sign = !matches!(self.verdict, MapVerdict::NoGradient | MapVerdict::Flat);
        (is_sign && self.z_score != 0.0).then_some(self.z_score * green > 0.0)
    }

    fn line(&self) -> String {
        let Self { number, truth, verdict, confidence, z_score, log_energy_ratio } = self;
        format!("{number},{truth:?},{verdict:?},{confidence},{z_score},{log_energy_ratio}")
    }

    fn from_line(line: &str) -> Option<Self> {
        let mut fields = line.split(',');
        let number = fields.next()?.parse().ok()?;
        let truth = Truth::from_name(fields.next()?)?;
        let name = fields.next()?;
        let verdict = VERDICTS.into_iter().find(|verdict| format!("{verdict:?}") == name)?;
        let mut number_of = || fields.next()?.parse().ok();
        Some(Self {
            number,
            truth,
            verdict,
            confidence: number_of()?,
            z_score: number_of()?,
            log_energy_ratio: number_of()?,
        })
    }
}

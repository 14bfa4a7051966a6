//! Counts verdicts on generated maps by what the maps are.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::damage::Storage;
use super::outcome::{MapSet, Outcome, Success};

/// Right, wrong and missing verdicts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Right verdicts.
    pub right: usize,
    /// Wrong verdicts.
    pub wrong: usize,
    /// Maps without a verdict.
    pub undecided: usize,
}

impl Counts {
    /// The counts of outcomes.
    pub fn of<'a>(outcomes: impl IntoIterator<Item = &'a Outcome>) -> Self {
        let mut counts = Self::default();
        for outcome in outcomes {
            *match outcome.success() {
                Success::Right => &mut counts.right,
                Success::Wrong => &mut counts.wrong,
                Success::Undecided => &mut counts.undecided,
            } += 1;
        }
        counts
    }

    fn row(&self, name: &str) -> String {
        let Self { right, wrong, undecided } = *self;
        let all = right + wrong + undecided;
        let percent = |count: usize| 100.0 * count as f64 / all.max(1) as f64;
        format!(
            "| {name} | {all} | {right} ({:.2} %) | {wrong} ({:.2} %) | {undecided} ({:.2} %) |\n",
            percent(right),
            percent(wrong),
            percent(undecided)
        )
    }
}

/// A table with one row per name that `name` gives to outcomes, sorted by name.
pub fn table<'a>(
    title: &str,
    outcomes: impl IntoIterator<Item = &'a Outcome>,
    name: impl Fn(&Outcome) -> String,
) -> String {
    let mut groups: BTreeMap<String, Vec<&Outcome>> = BTreeMap::new();
    for outcome in outcomes {
        groups.entry(name(outcome)).or_default().push(outcome);
    }
    let head = format!("| {title} | maps | right | wrong | cannot tell |\n|---|--:|--:|--:|--:|\n");
    groups.into_iter().fold(head, |text, (name, group)| text + &Counts::of(group).row(name.trim()))
}

/// The storage without its numbers.
pub fn storage_name(storage: Storage) -> &'static str {
    match storage {
        Storage::Rounded => "8-bit rounding",
        Storage::ChannelBlocks => "blocks per channel, as BC5",
        Storage::ColorBlocks => "blocks of colours, as BC1",
        Storage::Jpeg { halves_colors: false, .. } => "JPEG",
        Storage::Jpeg { halves_colors: true, .. } => "JPEG with halved colours",
    }
}

/// The gradients that got a wrong verdict or none, one per line.
pub fn failures(set: &MapSet, outcomes: &[Outcome]) -> String {
    let is_failure =
        |outcome: &&Outcome| outcome.truth.green().is_some() && outcome.success() != Success::Right;
    outcomes.iter().filter(is_failure).fold(String::new(), |mut text, outcome| {
        let Outcome { number, truth, verdict, z_score, log_energy_ratio, .. } = outcome;
        _ = writeln!(
            text,
            "{number}: {truth:?} judged {verdict:?}, z score {z_score:.1}, log energy ratio \
             {log_energy_ratio:.2}; {:?}",
            set.case(*number)
        );
        text
    })
}

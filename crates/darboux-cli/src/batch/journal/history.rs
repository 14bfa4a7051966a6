//! What the lines of a journal say.

use std::collections::{HashMap, HashSet};
use std::io;

use darboux_io::RunId;
use serde::{Deserialize, Serialize};

use super::record::Record;

/// After this many killed runs at work on an output, its file is skipped.
pub const MOST_ATTEMPTS: usize = 2;

/// The line that marks the start of a run.
#[derive(Serialize, Deserialize)]
pub struct RunStart {
    pub run: String,
}

/// The line that marks the start of work on an output.
#[derive(Serialize, Deserialize)]
pub struct Begun {
    pub begun: String,
}

/// The line that marks the end of work that leaves no record.
#[derive(Serialize, Deserialize)]
pub struct Ended {
    pub ended: String,
}

/// The line of an output that did not exist when a run planned it: what exists later, may be that run's.
#[derive(Serialize, Deserialize)]
pub struct Planned {
    pub planned: String,
}

/// The line that marks that a signal ends the run. No file is to blame for it.
#[derive(Serialize, Deserialize)]
pub struct Interrupted {
    pub interrupted: String,
}

/// What the lines say.
#[derive(Default)]
pub struct History {
    /// All runs that ever started in the folder.
    pub runs: HashSet<RunId>,
    pub records: HashMap<String, Record>,
    /// How many killed runs were at work on an output when they ended; 0 where a run may have written it
    /// without leaving a record.
    attempts: HashMap<String, usize>,
    /// The outputs that the latest run is at work on, and whether each was known before.
    at_work: HashMap<String, bool>,
    /// Whether a signal ends the latest run.
    is_interrupted: bool,
}

impl History {
    /// Reads the lines of a journal. Broken ones are ignored.
    pub fn of(bytes: &[u8]) -> Self {
        let mut history = Self::default();
        lines(bytes).for_each(|line| history.read(line));
        history
    }

    fn read(&mut self, line: &[u8]) {
        if let Ok(record) = serde_json::from_slice::<Record>(line) {
            self.attempts.remove(&record.output);
            self.at_work.remove(&record.output);
            self.records.insert(record.output.clone(), record);
        } else if let Ok(Begun { begun }) = serde_json::from_slice(line) {
            let was_known = self.attempts.contains_key(&begun);
            self.at_work.insert(begun.clone(), was_known);
            *self.attempts.entry(begun).or_default() += usize::from(!self.is_interrupted);
        } else if let Ok(Ended { ended }) = serde_json::from_slice(line) {
            match self.at_work.remove(&ended) {
                Some(true) => self.attempts.insert(ended, 0),
                _ => self.attempts.remove(&ended),
            };
        } else if let Ok(Planned { planned }) = serde_json::from_slice(line) {
            self.attempts.entry(planned).or_default();
        } else if serde_json::from_slice::<Interrupted>(line).is_ok() {
            self.is_interrupted = true;
            for output in self.at_work.keys() {
                if let Some(count) = self.attempts.get_mut(output) {
                    *count = count.saturating_sub(1);
                }
            }
        } else if let Ok(RunStart { run }) = serde_json::from_slice(line) {
            self.runs.extend(run.parse::<RunId>());
            self.at_work.clear();
            self.is_interrupted = false;
        }
    }

    /// How many killed runs were at work on an output; none where no run can have written it without leaving
    /// a record.
    pub fn attempts(&self, output: &str) -> Option<usize> {
        self.attempts.get(output).copied()
    }

    /// The number of lines of [`History::text`].
    pub fn line_count(&self) -> usize {
        let attempts = self.attempts.values().map(|&count| count.clamp(1, MOST_ATTEMPTS));
        self.runs.len() + self.records.len() + attempts.sum::<usize>()
    }

    /// The lines that say the same, in an order that does not depend on chance. The last one is the start of
    /// the run `latest`, so that what this run begins is told from what earlier runs began.
    pub fn text(&self, latest: RunId) -> io::Result<Vec<u8>> {
        let mut text = Vec::new();
        let earlier = self.runs.iter().filter(|&&run| run != latest);
        let mut runs: Vec<String> = earlier.map(RunId::to_string).collect();
        runs.sort();
        for run in runs {
            append_line(&mut text, &RunStart { run })?;
        }
        let mut records: Vec<&Record> = self.records.values().collect();
        records.sort_by(|a, b| a.output.cmp(&b.output));
        for record in records {
            append_line(&mut text, record)?;
        }
        let mut attempts: Vec<_> = self.attempts.iter().collect();
        attempts.sort();
        for (output, &count) in attempts {
            if count == 0 {
                append_line(&mut text, &Planned { planned: output.clone() })?;
            }
            for _ in 0..count.min(MOST_ATTEMPTS) {
                append_line(&mut text, &Begun { begun: output.clone() })?;
            }
        }
        append_line(&mut text, &RunStart { run: latest.to_string() })?;
        Ok(text)
    }
}

/// The lines that are not empty.
pub fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes.split(|&byte| byte == b'\n').filter(|line| !line.is_empty())
}

/// Appends a value and a line break to `text`.
pub fn append_line(text: &mut Vec<u8>, value: &impl Serialize) -> io::Result<()> {
    serde_json::to_writer(&mut *text, value)?;
    text.push(b'\n');
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attempts(text: &str) -> Option<usize> {
        let history = History::of(text.as_bytes());
        let compact = history.text(RunId(0x0123_4567_89ab_cdef)).expect("a text");
        assert_eq!(History::of(&compact).attempts("a"), history.attempts("a"), "compacting changes nothing");
        assert_eq!(lines(&compact).count(), history.line_count());
        history.attempts("a")
    }

    /// Tests begin with a run, as journals do.
    const RUN: &str = "{\"run\":\"0123456789abcdef\"}\n";
    const BEGUN: &str = "{\"begun\":\"a\"}\n";
    const ENDED: &str = "{\"ended\":\"a\"}\n";
    const PLANNED: &str = "{\"planned\":\"a\"}\n";
    const INTERRUPTED: &str = "{\"interrupted\":\"0123456789abcdef\"}\n";

    #[test]
    fn killed_runs_count_and_interrupted_ones_do_not() {
        let of = |parts: &[&str]| attempts(&parts.concat());
        assert_eq!(of(&[RUN]), None);
        assert_eq!(of(&[RUN, BEGUN]), Some(1));
        assert_eq!(of(&[RUN, BEGUN, ENDED]), None);
        assert_eq!(of(&[RUN, BEGUN, INTERRUPTED]), Some(0));
        assert_eq!(of(&[RUN, BEGUN, INTERRUPTED, RUN, BEGUN, INTERRUPTED]), Some(0));
        // What begins between the note and the end of the process.
        assert_eq!(of(&[RUN, INTERRUPTED, BEGUN]), Some(0));
        assert_eq!(of(&[RUN, INTERRUPTED, BEGUN, RUN, BEGUN]), Some(1));
        // An earlier run was killed.
        assert_eq!(of(&[RUN, BEGUN, RUN, BEGUN, INTERRUPTED]), Some(1));
        assert_eq!(of(&[RUN, BEGUN, RUN, INTERRUPTED]), Some(1));
        // What a run may have written stays known although a later one fails.
        assert_eq!(of(&[RUN, BEGUN, INTERRUPTED, RUN, BEGUN, ENDED]), Some(0));
        assert_eq!(of(&[RUN, PLANNED, RUN, BEGUN, ENDED]), Some(0));
        assert_eq!(of(&[RUN, PLANNED, RUN, BEGUN]), Some(1));
    }
}

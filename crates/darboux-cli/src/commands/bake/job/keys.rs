//! The keys of a job file: the options of the command by clap's own list.

use std::any::TypeId;
use std::path::PathBuf;

use clap::{Arg, ArgAction, Args, Command};

use crate::commands::bake::arguments::BakeArguments;

/// Options about the whole job, which stand beside it only.
const OF_RUNS: [&str; 5] = ["suffixes", "resume", "retry", "json", "quiet"];

/// Permissions and limits, which may stand beside the job, too, and count for all its bakes then.
const LIMITS: [&str; 4] = ["jobs", "memory-limit", "allow-outside", "force"];

/// The options of `darboux bake`.
pub struct Keys {
    command: Command,
}

impl Keys {
    pub fn new() -> Self {
        Self { command: BakeArguments::augment_args(Command::new("darboux bake")) }
    }

    /// The option with a key; none where no bake of a job has one.
    pub fn find(&self, key: &str) -> Option<Key<'_>> {
        let mut all = self.command.get_arguments();
        let argument = all.find(|argument| name(argument) == Some(key))?;
        (!OF_RUNS.contains(&key)).then_some(Key { argument })
    }

    /// Whether a key belongs beside the job, not into it.
    pub fn is_of_runs(key: &str) -> bool {
        OF_RUNS.contains(&key)
    }

    /// The key that was most likely meant.
    pub fn similar(&self, key: &str) -> Option<&str> {
        let all = self.command.get_arguments().filter_map(name).filter(|name| !OF_RUNS.contains(name));
        let distances = all.map(|name| (distance(name, key), name));
        let (distance, name) = distances.min()?;
        (distance <= 2 && distance < key.len()).then_some(name)
    }

    /// The options given beside a job file that belong into its bakes.
    pub fn misplaced(&self, arguments: &BakeArguments) -> Vec<String> {
        let mut names = arguments.given.names(&self.command);
        names.retain(|name| !OF_RUNS.contains(&name.as_str()) && !LIMITS.contains(&name.as_str()));
        names
    }
}

/// An option.
pub struct Key<'a> {
    argument: &'a Arg,
}

impl Key<'_> {
    /// Whether its values are paths.
    pub fn has_paths(&self) -> bool {
        self.argument.get_value_parser().type_id() == TypeId::of::<PathBuf>()
    }

    /// Whether several values are several options; otherwise they are one text.
    pub fn is_repeated(&self) -> bool {
        matches!(self.argument.get_action(), ArgAction::Append)
    }
}

/// The key of an option: its long name, or that of the positional argument.
fn name(argument: &Arg) -> Option<&str> {
    if argument.is_positional() { Some(argument.get_id().as_str()) } else { argument.get_long() }
}

/// How many letters have to be inserted, removed or replaced.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().take(64).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, other) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(letter != *other);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_those_of_the_command() {
        let keys = Keys::new();
        for key in
            ["low", "high", "output", "cage", "write-cage", "write-model", "heat-map", "heat-model", "report"]
        {
            assert!(keys.find(key).is_some_and(|key| key.has_paths()), "{key}");
        }
        for key in ["size", "map", "distance", "auto-cage", "skew", "match", "verify"] {
            assert!(keys.find(key).is_some_and(|key| !key.has_paths()), "{key}");
        }
        for (key, is_repeated) in
            [("high", true), ("map", true), ("pack", true), ("size", false), ("distance", false)]
        {
            assert_eq!(keys.find(key).map(|key| key.is_repeated()), Some(is_repeated), "{key}");
        }
        for key in OF_RUNS.into_iter().chain(["sise", "o", ""]) {
            assert!(keys.find(key).is_none(), "{key}");
        }
        for key in LIMITS {
            assert!(keys.find(key).is_some(), "{key}");
        }
        assert_eq!(keys.similar("sise"), Some("size"));
        assert_eq!(keys.similar("cage_offset"), Some("cage-offset"));
        assert_eq!(keys.similar("colour-scheme"), None);
    }

    #[test]
    fn distances_count_letters() {
        for (a, b, expected) in [("", "abc", 3), ("size", "sise", 1), ("map", "maps", 1), ("ab", "ba", 2)] {
            assert_eq!((distance(a, b), distance(b, a)), (expected, expected), "{a} {b}");
        }
    }
}

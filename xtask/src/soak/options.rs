//! The options of `cargo xtask soak`.

use std::path::PathBuf;
use std::time::Duration;

pub const USAGE: &str = "\
usage: cargo xtask soak [--minutes N] [--cases N] [--seed S] [--program PATH] [--models FOLDER] [--keep \
FOLDER] [--only WORD] [--case I]
  --minutes N      how long to run; by default 10
  --cases N        run the cases 0 to N - 1 instead, however long they take
  --seed S         where the random numbers start; the same seed gives the same cases; by default 1
  --program PATH   the darboux to run; by default a release build with all features
  --models FOLDER  models to damage, beside those of this repository
  --keep FOLDER    where cases that broke a promise are kept; by default target/soak/broken
  --only WORD      run only the directed cases whose name contains this word, eight times each
  --case I         run only the case with this number";

/// What a soak runs, and for how long.
#[derive(Debug, PartialEq)]
pub struct Options {
    pub duration: Duration,
    /// How many cases to run instead.
    pub cases: Option<u64>,
    pub seed: u64,
    /// `None`: build it.
    pub program: Option<PathBuf>,
    pub models: Option<PathBuf>,
    pub keep: Option<PathBuf>,
    pub only: Option<String>,
    pub case: Option<u64>,
}

impl Options {
    /// Parses the words after `soak`. Errors: an unknown option, or a value that does not fit it.
    pub fn parse(words: &[&str]) -> Result<Self, String> {
        let mut options = Self {
            duration: Duration::from_secs(600),
            cases: None,
            seed: 1,
            program: None,
            models: None,
            keep: None,
            only: None,
            case: None,
        };
        let mut words = words.iter();
        while let Some(&option) = words.next() {
            if option == "--help" {
                return Err(USAGE.into());
            }
            let value = words.next().ok_or_else(|| format!("{option} needs a value\n{USAGE}"))?;
            let number = || value.parse().map_err(|_| format!("{option}: {value} is not a number\n{USAGE}"));
            match option {
                "--minutes" => options.duration = Duration::from_secs(60 * number()?),
                "--cases" => options.cases = Some(number()?),
                "--seed" => options.seed = number()?,
                "--case" => options.case = Some(number()?),
                "--program" => options.program = Some(value.into()),
                "--models" => options.models = Some(value.into()),
                "--keep" => options.keep = Some(value.into()),
                "--only" => options.only = Some((*value).to_owned()),
                _ => return Err(format!("{option} is not an option\n{USAGE}")),
            }
        }
        Ok(options)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_have_values() {
        assert_eq!(Options::parse(&["--cases", "9"]).map(|options| options.cases), Ok(Some(9)));
        let options = Options::parse(&["--minutes", "2", "--seed", "7"]).expect("options");
        assert_eq!((options.duration, options.seed, options.case), (Duration::from_secs(120), 7, None));
        for words in [&["--seed"][..], &["--seed", "x"], &["--fast", "1"]] {
            assert!(Options::parse(words).is_err(), "{words:?}");
        }
    }
}

//! The entries of a TOML file.
//!
//! Each table of `[[bake]]` is a run of the command: `low`, `high` and `output`, and any option by its name
//! without dashes. `[defaults]` has what entries leave out. Paths are relative to the file.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use clap::Parser;
use clap::error::{ContextKind, ContextValue};
use darboux_io::system_reason;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::entry::Entry;
use super::keys::{Key, Keys};
use crate::commands::bake::arguments::BakeArguments;
use crate::regular_file::{Links, open_regular};

/// The longest job. Its tables take fifty times as much memory.
const MAX_LENGTH: u64 = 4 << 20;

/// The longest options of all bakes together: each has the defaults, too.
const MAX_OPTIONS: usize = 16 << 20;

#[derive(Parser)]
#[command(name = "darboux bake", no_binary_name = true, disable_help_flag = true)]
struct CommandLine {
    #[command(flatten)]
    arguments: BakeArguments,
}

/// What is wrong with a job: a clause, and the byte where.
struct Problem {
    at: usize,
    what: String,
}

type Values<'a> = BTreeMap<&'a str, (usize, &'a Spanned<DeValue<'a>>)>;

/// Reads the entries. Errors are one sentence each.
pub fn entries(path: &Path) -> Result<Vec<Entry>, String> {
    let shown = path.display();
    let text =
        read_text(path).map_err(|error| format!("{shown}: cannot be read: {}", system_reason(&error)))?;
    if text.len() as u64 > MAX_LENGTH {
        return Err(format!("{shown}: has more than 4 MiB; divide the job"));
    }
    let breaks: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
    let place =
        |at: usize| format!("{shown}: line {}", 1 + breaks.partition_point(|line_break| *line_break < at));
    let sentence = |Problem { at, what }: Problem| format!("{}: {what}", place(at));
    let job = DeTable::parse(&text).map_err(|error| {
        let at = error.span().map_or(0, |span| span.start);
        sentence(Problem { at, what: format!("{}; correct it", error.message()) })
    })?;
    let (defaults, bakes) = tables(job.get_ref()).map_err(sentence)?;
    if bakes.is_empty() {
        return Err(format!("{shown}: has no [[bake]]; add one for each low model"));
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let keys = Keys::new();
    let (mut entries, mut length) = (Vec::new(), 0);
    for (at, own) in bakes {
        let mut all = defaults.clone();
        all.extend(own);
        let entry = read(&keys, &all, at, folder, place(at)).map_err(sentence)?;
        length += entry.options.len();
        if length > MAX_OPTIONS {
            let what = "the options of the bakes up to here have more than 16 MiB, with [defaults] in each; \
                        divide the job"
                .to_owned();
            return Err(sentence(Problem { at, what }));
        }
        entries.push(entry);
    }
    Ok(entries)
}

/// A text, or the part of a longer one that shows that it is too long.
fn read_text(path: &Path) -> io::Result<String> {
    let file = open_regular(path, File::options().read(true), Links::Follow)?;
    let mut text = String::new();
    file.take(MAX_LENGTH + 1).read_to_string(&mut text)?;
    Ok(text)
}

/// The values of `[defaults]`, and the values of each `[[bake]]` with its place.
fn tables<'a>(job: &'a DeTable<'a>) -> Result<(Values<'a>, Vec<(usize, Values<'a>)>), Problem> {
    let (mut defaults, mut bakes) = (Values::new(), Vec::new());
    for (key, value) in job {
        let at = value.span().start;
        let problem = |what: &str| Problem { at: key.span().start, what: what.to_owned() };
        match (key.get_ref().as_ref(), value.get_ref()) {
            ("defaults", DeValue::Table(table)) => defaults = values(table),
            ("defaults", _) => return Err(problem("defaults is no table; write [defaults]")),
            ("bake", DeValue::Array(tables)) => {
                for table in tables {
                    let at = table.span().start;
                    let own =
                        table.get_ref().as_table().ok_or_else(|| problem("bake is no table; write [[bake]]"));
                    bakes.push((at, values(own?)));
                }
            }
            ("bake", _) => return Err(Problem { at, what: "bake is one table; write [[bake]]".to_owned() }),
            (key, _) => {
                return Err(problem(&format!("has {key}; a job has [defaults] and tables of [[bake]]")));
            }
        }
    }
    Ok((defaults, bakes))
}

fn values<'a>(table: &'a DeTable<'a>) -> Values<'a> {
    table.iter().map(|(key, value)| (key.get_ref().as_ref(), (key.span().start, value))).collect()
}

/// Parses an entry as a command line. `at`: where its table begins.
fn read(keys: &Keys, values: &Values<'_>, at: usize, folder: &Path, place: String) -> Result<Entry, Problem> {
    let low = values.get("low").and_then(|(_, value)| value.get_ref().as_str());
    let low =
        low.ok_or_else(|| Problem { at, what: "this [[bake]] has no low; name the low model".to_owned() })?;
    let mut line = vec![in_folder(folder, low)];
    for (&name, &(at, value)) in values.iter().filter(|(name, _)| **name != "low") {
        let key = keys.find(name).ok_or_else(|| Problem { at, what: no_key(keys, name) })?;
        for text in texts(&key, name, at, value.get_ref())? {
            line.push(match text {
                None => format!("--{name}"),
                Some(text) if key.has_paths() || is_image_of_skew(name, &text) => {
                    format!("--{name}={}", in_folder(folder, &text))
                }
                Some(text) => format!("--{name}={text}"),
            });
        }
    }
    let parsed = CommandLine::try_parse_from(&line).map_err(|error| {
        let at = key_of(&error).and_then(|key| values.get(key.as_str())).map_or(at, |(at, _)| *at);
        Problem { at, what: first_line(&error.to_string()) }
    })?;
    Ok(Entry { arguments: parsed.arguments.completed(), options: line.join("\u{1f}"), place: Some(place) })
}

/// Whether a value of `skew` is an image: unless it is an amount.
fn is_image_of_skew(name: &str, text: &str) -> bool {
    name == "skew" && text.parse::<f32>().is_err()
}

fn no_key(keys: &Keys, name: &str) -> String {
    if Keys::is_of_runs(name) {
        return format!(
            "{name} is about the whole job; leave it out here, and write --{name} beside the job"
        );
    }
    let hint = keys.similar(name).map(|similar| format!("; {similar} is one")).unwrap_or_default();
    format!("{name} is no option of darboux bake{hint}")
}

/// The values of an option as the command line has them; none for an option without a value, and no element
/// for one that is off. `at`: where its key is.
fn texts(key: &Key<'_>, name: &str, at: usize, value: &DeValue<'_>) -> Result<Vec<Option<String>>, Problem> {
    let problem = |what: String| Problem { at, what };
    let one = |text: String| Ok(vec![Some(text)]);
    match value {
        DeValue::Boolean(true) => Ok(vec![None]),
        DeValue::Boolean(false) => Ok(Vec::new()),
        DeValue::String(text) => one(text.clone().into_owned()),
        DeValue::Integer(number) => {
            let parsed = i64::from_str_radix(number.as_str(), number.radix());
            one(parsed.map_err(|_| problem(format!("{name} is too large a number")))?.to_string())
        }
        DeValue::Float(number) => {
            let parsed: Result<f64, _> = number.as_str().parse();
            one(parsed.map_err(|_| problem(format!("{name} is no number that can be read")))?.to_string())
        }
        DeValue::Array(values) => {
            let mut all = Vec::new();
            for value in values {
                all.extend(texts(key, name, at, value.get_ref())?);
            }
            if key.is_repeated() {
                return Ok(all);
            }
            let separator = if name == "size" { "x" } else { "," };
            let parts: Vec<String> = all.into_iter().flatten().collect();
            one(parts.join(separator))
        }
        DeValue::Datetime(_) | DeValue::Table(_) => {
            Err(problem(format!("{name} is neither text nor a number; correct it")))
        }
    }
}

/// The key of the option that a message of clap is about.
fn key_of(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(argument)) = error.get(ContextKind::InvalidArg) else { return None };
    let name = argument.trim_start_matches('-');
    Some(name.split([' ', '=', '[']).next()?.to_owned())
}

/// What clap says, without its hints.
fn first_line(message: &str) -> String {
    let line = message.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    line.trim_start_matches("error: ").to_owned()
}

/// A path of a job, relative to the job's folder. One that begins with a dash is no option.
fn in_folder(folder: &Path, path: &str) -> String {
    let folder = if folder.as_os_str().is_empty() && path.starts_with('-') { Path::new(".") } else { folder };
    folder.join(path).display().to_string()
}

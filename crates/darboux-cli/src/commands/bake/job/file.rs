//! The entries of a TOML file.
//!
//! Each table of `[[bake]]` is a run of the command: `low`, `high` and `output`, and any option by its name without dashes. `[defaults]` has what entries
//! leave out. Paths are relative to the file.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use clap::Parser;
use darboux_io::system_reason;
use toml::{Table, Value};

use super::entry::Entry;
use crate::commands::bake::arguments::BakeArguments;
use crate::regular_file::{Links, open_regular};

/// The longest job. Its tables take fifty times as much memory.
const MAX_LENGTH: u64 = 4 << 20;

/// The keys whose values are paths.
const PATHS: [&str; 9] =
    ["low", "high", "output", "cage", "write-cage", "write-model", "heat-map", "heat-model", "report"];

/// Options whose value is one text of several elements, with commas.
const LISTS: [&str; 5] = ["map", "size", "distance", "world-direction", "heat-range"];

#[derive(Parser)]
#[command(name = "darboux bake", no_binary_name = true, disable_help_flag = true)]
struct CommandLine {
    #[command(flatten)]
    arguments: BakeArguments,
}

/// Reads the entries. Errors are one sentence each.
pub fn entries(path: &Path) -> Result<Vec<Entry>, String> {
    let shown = path.display();
    let text =
        read_text(path).map_err(|error| format!("{shown}: cannot be read: {}", system_reason(&error)))?;
    if text.len() as u64 > MAX_LENGTH {
        return Err(format!("{shown}: has more than 4 MiB; divide the job"));
    }
    let job: Table = text.parse().map_err(|error: toml::de::Error| {
        let line = error.span().map_or(0, |span| text[..span.start].lines().count().max(1));
        format!("{shown}: line {line}: {}; correct it", error.message())
    })?;
    if let Some(key) = job.keys().find(|key| !["defaults", "bake"].contains(&key.as_str())) {
        return Err(format!("{shown}: has {key}; a job has [defaults] and tables of [[bake]]"));
    }
    let defaults = match job.get("defaults") {
        None => Table::new(),
        Some(Value::Table(defaults)) => defaults.clone(),
        Some(_) => return Err(format!("{shown}: defaults is no table; write [defaults]")),
    };
    let tables = job.get("bake").and_then(Value::as_array).filter(|tables| !tables.is_empty());
    let tables = tables.ok_or_else(|| format!("{shown}: has no [[bake]]; add one for each low model"))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let entry = |(index, table): (usize, &Value)| {
        let at = format!("{shown}: bake[{index}]");
        let table = table.as_table().ok_or_else(|| format!("{at}: is no table; write [[bake]]"))?;
        let mut all = defaults.clone();
        all.extend(table.clone());
        read(&all, folder).map_err(|problem| format!("{at}: {problem}"))
    };
    tables.iter().enumerate().map(entry).collect()
}

/// A text, or the part of a longer one that shows that it is too long.
fn read_text(path: &Path) -> io::Result<String> {
    let file = open_regular(path, File::options().read(true), Links::Follow)?;
    let mut text = String::new();
    file.take(MAX_LENGTH + 1).read_to_string(&mut text)?;
    Ok(text)
}

/// The error is a clause.
fn read(table: &Table, folder: &Path) -> Result<Entry, String> {
    let low = table.get("low").and_then(Value::as_str).ok_or("has no low; name the low model")?;
    let mut line = vec![in_folder(folder, low)];
    for (key, value) in table.iter().filter(|(key, _)| *key != "low") {
        let values = texts(key, value)?;
        if let (true, [_, ..]) = (key == "high", &values[..]) {
            line.push("--high".to_owned());
            line.extend(values.iter().map(|path| in_folder(folder, path)));
            continue;
        }
        for text in values {
            // An image, unless it is an amount.
            let is_image = key == "skew" && text.parse::<f32>().is_err();
            let is_path = is_image || PATHS.contains(&key.as_str());
            let text = if is_path { in_folder(folder, &text) } else { text };
            line.push(if text.is_empty() { format!("--{key}") } else { format!("--{key}={text}") });
        }
    }
    let parsed = CommandLine::try_parse_from(&line).map_err(|error| first_line(&error.to_string()))?;
    Ok(Entry { arguments: parsed.arguments, options: line.join("\u{1f}") })
}

/// The values of an option as the command line has them; an empty text for an option without a value, and none for one that is off.
fn texts(key: &str, value: &Value) -> Result<Vec<String>, String> {
    Ok(match value {
        Value::Boolean(true) => vec![String::new()],
        Value::Boolean(false) => Vec::new(),
        Value::String(text) => vec![text.clone()],
        Value::Integer(number) => vec![number.to_string()],
        Value::Float(number) => vec![number.to_string()],
        Value::Array(values) => {
            let texts: Vec<Vec<String>> =
                values.iter().map(|value| texts(key, value)).collect::<Result<_, _>>()?;
            let separator = if key == "size" { "x" } else { "," };
            let texts = texts.concat();
            if LISTS.contains(&key) { vec![texts.join(separator)] } else { texts }
        }
        _ => return Err(format!("{key} is neither text nor a number; correct it")),
    })
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

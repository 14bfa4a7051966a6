//! The public names of each language, read from its own files.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::api;
use crate::run::root;

/// The entries of the npm package, with their prefix in the table.
const ENTRIES: [(&str, &str); 8] = [
    ("", "darboux"),
    ("tangents:", "tangents"),
    ("check:", "check"),
    ("bake:", "bake"),
    ("three:", "three"),
    ("gltf-transform:", "gltf-transform"),
    ("mikktspace:", "mikktspace"),
    ("webgpu:", "webgpu"),
];

/// The texts that declare the names of each language.
pub struct Names {
    /// The lists of the Rust API, one item per line.
    rust: String,
    c: String,
    cpp: String,
    python: BTreeSet<String>,
    js: BTreeSet<String>,
    command: String,
}

impl Names {
    /// `into`: where the generated lists lie. Errors: a file cannot be read.
    pub fn read(into: &Path) -> Result<Self, String> {
        let lists = api::PACKAGES.iter().map(|package| read(&into.join(format!("docs/api/{package}.txt"))));
        Ok(Self {
            rust: lists.collect::<Result<Vec<_>, _>>()?.join("\n"),
            c: read(&into.join("bindings/c/include/darboux.h"))?,
            cpp: read(&root().join("bindings/c/include/darboux.hpp"))?,
            python: python_names()?,
            js: js_names()?,
            command: read(&into.join("docs/cli.md"))?,
        })
    }

    /// Whether a language, by its column, has a name.
    pub fn has(&self, language: usize, name: &str) -> bool {
        match language {
            0 => self.has_rust(name),
            1 => self.c.contains(&format!("{name}(")),
            2 => words(&self.cpp).any(|word| word == name),
            3 => self.python.contains(name),
            4 => self.js.contains(name),
            _ => self.command.contains(&format!("\n## `{name}`\n")),
        }
    }

    /// Names of the core have no crate in the table.
    fn has_rust(&self, name: &str) -> bool {
        let full = if name.starts_with("darboux_") { name.to_owned() } else { format!("darboux::{name}") };
        self.rust.lines().any(|line| {
            let item = line.trim_start_matches("#[non_exhaustive] ");
            let kinds = ["pub fn ", "pub async fn ", "pub const fn ", "pub struct ", "pub const "];
            let item = kinds.iter().find_map(|kind| item.strip_prefix(kind));
            item.is_some_and(|item| without_generics(item) == full)
        })
    }

    /// The functions and classes of a language that users call. Of Rust, C++ and the command the table is a
    /// choice.
    pub fn functions(&self, language: usize) -> Vec<String> {
        match language {
            1 => self.c_functions(),
            3 => {
                let is_function =
                    |name: &&String| name.starts_with(|c: char| c.is_lowercase()) && *name != "encode";
                self.python.iter().filter(is_function).cloned().collect()
            }
            4 => self.js.iter().filter(|name| !name.contains('.')).cloned().collect(),
            _ => Vec::new(),
        }
    }

    /// The names before a parenthesis.
    fn c_functions(&self) -> Vec<String> {
        let heads = self
            .c
            .lines()
            .filter(|line| !line.trim_start().starts_with("///"))
            .filter_map(|line| line.split_once('('));
        let names = heads.filter_map(|(head, _)| words(head).last().filter(|_| !head.ends_with(' ')));
        names.filter(|name| name.starts_with("darboux_")).map(str::to_owned).collect()
    }
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{} cannot be read: {error}", path.display()))
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

/// The name of an item: `Plan<'a>::new(...) -> Self` becomes `Plan::new`.
fn without_generics(item: &str) -> String {
    let mut depth = 0;
    let mut name = String::new();
    for c in item.split(['(', ' ']).next().unwrap_or_default().trim_end_matches(':').chars() {
        match c {
            '<' => depth += 1,
            '>' => depth -= 1,
            _ if depth == 0 => name.push(c),
            _ => {}
        }
    }
    name
}

/// The names of `__all__` of the package and of `darboux.encode`, and the members of the classes.
fn python_names() -> Result<BTreeSet<String>, String> {
    let package = root().join("bindings/python/python/darboux");
    let listed = |file: &str, prefix: &str| -> Result<Vec<String>, String> {
        let text = read(&package.join(file))?;
        let list = text.split_once("__all__ = [").and_then(|(_, rest)| rest.split_once(']'));
        let list = list.ok_or_else(|| format!("{file} has no __all__"))?.0;
        Ok(list.split('"').skip(1).step_by(2).map(|name| format!("{prefix}{name}")).collect())
    };
    let mut names: BTreeSet<String> = listed("__init__.py", "")?.into_iter().collect();
    names.extend(listed("encode.py", "encode.")?);
    let mut class = None;
    for line in read(&package.join("_darboux.pyi"))?.lines() {
        if let Some(name) = line.strip_prefix("class ") {
            class = words(name).next().map(str::to_owned);
        } else if let (Some(class), Some(member)) = (&class, line.strip_prefix("    def ")) {
            names.extend(words(member).next().map(|member| format!("{class}.{member}")));
        } else if line.starts_with("def ") {
            class = None;
        }
    }
    Ok(names)
}

/// The values that the entries export, and the members of their classes.
fn js_names() -> Result<BTreeSet<String>, String> {
    let mut names = BTreeSet::new();
    for (prefix, entry) in ENTRIES {
        let text = read(&root().join(format!("bindings/js/lib/{entry}.ts")))?;
        names.extend(exported(&text).into_iter().map(|name| format!("{prefix}{name}")));
        for (class, source) in classes(&text)? {
            names.extend(members(&source).into_iter().map(|member| format!("{prefix}{class}.{member}")));
        }
    }
    Ok(names)
}

/// The names of functions, classes and constants after `export`. Types are not values.
fn exported(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    for line in text.lines().filter_map(|line| line.strip_prefix("export ")) {
        if line.starts_with("type ") || line.starts_with("interface ") || line.starts_with("default") {
            continue;
        }
        match line.strip_prefix('{').and_then(|rest| rest.split_once('}')) {
            Some((list, _)) => names.extend(words(list).filter(|word| *word != "default").map(str::to_owned)),
            None => {
                let mut after = words(line).skip_while(|word| {
                    matches!(*word, "async" | "function" | "class" | "const" | "let" | "as")
                });
                names.extend(after.next().map(str::to_owned));
            }
        }
    }
    names
}

/// The classes that an entry declares or takes from a file beside it, and the text from their declaration on.
fn classes(text: &str) -> Result<Vec<(String, String)>, String> {
    let mut texts = vec![text.to_owned()];
    for line in text.lines().filter(|line| line.starts_with("export {")) {
        if let Some((_, path)) = line.split_once("from './") {
            let path = path.trim_end_matches(';').trim_end_matches('\'').replace(".js", ".ts");
            texts.push(read(&root().join("bindings/js/lib").join(path))?);
        }
    }
    let declared = |text: String| -> Vec<(String, String)> {
        let parts = text.split("\nexport class ").skip(1);
        parts.filter_map(|part| Some((words(part).next()?.to_owned(), part.to_owned()))).collect()
    };
    Ok(texts.into_iter().flat_map(declared).collect())
}

/// The members of a class: lines that are indented by two spaces and begin with a name.
fn members(source: &str) -> Vec<String> {
    let body = source.split("\n}\n").next().unwrap_or_default();
    let lines = body.lines().filter_map(|line| line.strip_prefix("  "));
    let lines = lines.filter(|line| line.starts_with(|c: char| c.is_alphabetic()));
    let is_modifier = |word: &&str| matches!(*word, "readonly" | "get" | "async" | "static");
    lines.filter_map(|line| words(line).find(|word| !is_modifier(word)).map(str::to_owned)).collect()
}

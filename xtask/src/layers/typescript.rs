//! Import graphs of TypeScript: a file imports the files that its `import` and `export ... from` statements
//! name.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use super::cycles::Graph;
use crate::run::files_below;

/// The imports between the TypeScript files below a folder. Imports of packages are ignored.
pub fn imports(folder: &Path) -> Result<Graph, String> {
    let all = files_below(folder)?.into_iter();
    let files: BTreeSet<PathBuf> =
        all.filter(|path| path.extension().is_some_and(|extension| extension == "ts")).collect();
    let mut graph = Graph::default();
    for file in &files {
        let text = fs::read_to_string(file)
            .map_err(|error| format!("{} cannot be read: {error}", file.display()))?;
        for (names, module) in statements(&text) {
            if let Some(target) = resolve(file, &module, &files) {
                names.iter().for_each(|name| graph.add(file, &target, name));
            }
        }
    }
    Ok(graph)
}

/// The imported names and the relative module path of each import statement.
fn statements(text: &str) -> Vec<(Vec<String>, String)> {
    let mut found = Vec::new();
    let mut statement: Option<String> = None;
    for line in text.lines() {
        let begins =
            ["import ", "export {", "export *", "export type {"].iter().any(|word| line.starts_with(word));
        if statement.is_none() && !begins {
            found.extend(dynamic_import(line));
            continue;
        }
        let so_far = statement.take().unwrap_or_default() + line + "\n";
        if line.trim_end().ends_with([';', '\'', '"']) || line.trim_end() == "}" {
            found.extend(statement_parts(&so_far));
        } else {
            statement = Some(so_far);
        }
    }
    found
}

/// `import { a, b } from './c'` as the names a and b and the path ./c.
fn statement_parts(statement: &str) -> Option<(Vec<String>, String)> {
    let module = quoted(statement)?;
    let clause = statement.split(" from ").next().unwrap_or_default();
    let clause = clause.strip_prefix("import").or(clause.strip_prefix("export")).unwrap_or(clause);
    let names = clause.split(|c: char| !c.is_alphanumeric() && c != '_').map(str::trim);
    let names: Vec<String> =
        names.filter(|name| !name.is_empty() && !["type", "as"].contains(name)).map(str::to_owned).collect();
    let names = if clause.contains(&module) || names.is_empty() { vec!["*".to_owned()] } else { names };
    Some((names, module))
}

/// `import('./c')` inside a line of code.
fn dynamic_import(line: &str) -> Option<(Vec<String>, String)> {
    let (_, rest) = line.split_once("import(")?;
    Some((vec!["import()".to_owned()], quoted(rest)?))
}

/// The first relative path between quotes.
fn quoted(text: &str) -> Option<String> {
    let from = ["'.", "\"."].iter().filter_map(|start| text.find(start)).min()? + 1;
    let rest = &text[from..];
    Some(rest[..rest.find(['\'', '"'])?].to_owned())
}

/// The file that a relative path names, with or without its extension.
fn resolve(from: &Path, module: &str, files: &BTreeSet<PathBuf>) -> Option<PathBuf> {
    let joined = normalized(&from.parent()?.join(module));
    let text = joined.to_string_lossy();
    let stem = text.strip_suffix(".js").or(text.strip_suffix(".ts")).unwrap_or(&text);
    [format!("{stem}.ts"), format!("{stem}/index.ts")]
        .into_iter()
        .map(PathBuf::from)
        .find(|path| files.contains(path))
}

/// The path without `.` and `..`.
fn normalized(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => _ = out.pop(),
            Component::CurDir => {}
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_are_read() {
        let text = "import { a,\n  b } from './c';\nimport type { D } from \"../d\";\nimport './e.js';\n\
                    export * from './f';\nimport { x } from 'three';\nexport { g };\nconst h = await \
                    import('./h');\n";
        let found: Vec<_> =
            statements(text).into_iter().map(|(names, path)| (names.join(" "), path)).collect();
        let expected = [("a b", "./c"), ("D", "../d"), ("*", "./e.js"), ("*", "./f"), ("import()", "./h")];
        assert_eq!(found, expected.map(|(names, path)| (names.to_owned(), path.to_owned())));
    }

    #[test]
    fn paths_name_files() {
        let files = ["/l/a.ts", "/l/m/b.ts", "/l/n/index.ts"].map(PathBuf::from).into();
        let find = |module| resolve(Path::new("/l/m/b.ts"), module, &files);
        assert_eq!(find("../a.js"), Some("/l/a.ts".into()));
        assert_eq!(find("../n"), Some("/l/n/index.ts".into()));
        assert_eq!(find("./absent"), None);
    }
}

//! `cargo xtask layers`: checks which packages import which, and that the files of a package import each
//! other without cycles.
//!
//! Packages are compared with the table of ARCHITECTURE.md. Inside a package every file is a node, and a file
//! that names an item of another file gives an edge; a strongly connected group of files is an error.

mod cycles;
mod packages;
mod rust_imports;
mod typescript;

use std::path::PathBuf;

use crate::run::{Outcome, root};
use crate::rust_code::Crate;
use cycles::Graph;

/// Folders whose TypeScript files are checked.
const TYPESCRIPT: &[&str] = &["bindings/js/lib", "viewer/src"];

/// Errors: a package imports one that it may not, or files of one package import each other in a cycle.
pub fn check() -> Outcome {
    let packages = packages::all()?;
    let imports = packages::check(&packages);
    let mut graphs = Vec::new();
    for target in packages::targets(&packages) {
        let folder = target.parent().map(PathBuf::from).unwrap_or_default();
        let read = Crate::load(&target, &|path| std::fs::read_to_string(path).ok())?;
        graphs.push((folder, rust_imports::imports(&read)));
    }
    for folder in TYPESCRIPT {
        let folder = root().join(folder);
        let graph = typescript::imports(&folder)?;
        graphs.push((folder, graph));
    }
    report(&graphs).and(imports)
}

/// Prints every cycle. Errors: there is one.
fn report(graphs: &[(PathBuf, Graph)]) -> Outcome {
    let mut with_cycles = Vec::new();
    for (folder, graph) in graphs {
        let shown = folder.strip_prefix(root()).unwrap_or(folder).display().to_string();
        let name = |file: &PathBuf| file.strip_prefix(folder).unwrap_or(file).display().to_string();
        for chain in graph.cycles(&name) {
            println!("{shown}: {chain}");
            if !with_cycles.contains(&shown) {
                with_cycles.push(shown.clone());
            }
        }
    }
    if with_cycles.is_empty() {
        println!("{} crates and folders checked for import cycles", graphs.len());
        return Ok(());
    }
    Err(format!("files import each other in cycles, printed above, in {}", with_cycles.join(", ")))
}

//! Import graphs of Rust: a file imports from the file that defines an item which it names. `mod child;` is
//! not an import.

use super::cycles::Graph;
use crate::rust_code::Crate;

/// Which file imports which names from which.
pub fn imports(of: &Crate) -> Graph {
    let mut graph = Graph::default();
    for (index, module) in of.modules.iter().enumerate() {
        let imported = module.names.imports.iter().map(|(_, path)| path);
        let globs = module.names.globs.iter();
        for path in imported.chain(globs).chain(&module.names.paths) {
            if let Some((definer, name)) = of.item(index, path) {
                graph.add(&module.file, &of.modules[definer].file, &name);
            }
        }
        for name in &module.names.macros {
            if let Some(definer) = of.macro_definer(index, name) {
                graph.add(&module.file, &of.modules[definer].file, &format!("{name}!"));
            }
        }
    }
    graph
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// The cycles of a crate whose files are given by path and text.
    fn cycles(files: &[(&str, &str)]) -> Vec<String> {
        let read = |path: &Path| {
            let found = files.iter().find(|(name, _)| Path::new(name) == path);
            found.map(|(_, text)| (*text).to_owned())
        };
        let graph = imports(&Crate::load(Path::new(files[0].0), &read).expect("files that parse"));
        graph.cycles(&|file| file.display().to_string())
    }

    #[test]
    fn two_files_that_use_each_other_are_a_cycle() {
        let found = cycles(&[
            ("lib.rs", "mod a; mod b;"),
            ("a.rs", "use crate::b::B; pub struct A(B);"),
            ("b.rs", "pub struct B; impl B { fn f() { let _ = vec![crate::a::A::new()]; } }"),
        ]);
        assert_eq!(found, ["a.rs -> b.rs (B) -> a.rs (A)"]);
    }

    #[test]
    fn a_reexport_leads_to_the_file_that_defines_the_item() {
        let found = cycles(&[
            ("lib.rs", "mod group;"),
            ("group.rs", "mod a; mod b; pub use a::A; pub use b::*;"),
            ("group/a.rs", "use super::B; pub struct A(B);"),
            ("group/b.rs", "use super::A; pub struct B;"),
        ]);
        assert_eq!(found, ["group/a.rs -> group/b.rs (B) -> group/a.rs (A)"]);
        let one_way = cycles(&[
            ("lib.rs", "mod group;"),
            ("group/mod.rs", "mod a; mod b; pub use {a::A, b::B};"),
            ("group/a.rs", "use super::B; pub struct A(B);"),
            ("group/b.rs", "pub struct B;"),
        ]);
        assert!(one_way.is_empty(), "{one_way:?}");
    }

    #[test]
    fn a_child_that_needs_its_parent_is_a_cycle_only_if_the_parent_needs_it() {
        let child = ("a.rs", "use super::LIMIT; pub fn f() -> u32 { LIMIT }");
        assert!(cycles(&[("lib.rs", "mod a; const LIMIT: u32 = 1;"), child]).is_empty());
        let found = cycles(&[("lib.rs", "mod a; const LIMIT: u32 = 1; fn g() { a::f(); }"), child]);
        assert_eq!(found, ["a.rs -> lib.rs (LIMIT) -> a.rs (f)"]);
    }

    #[test]
    fn tests_may_use_everything() {
        let found = cycles(&[
            ("lib.rs", "mod a; pub fn f() { a::g(); }"),
            ("a.rs", "pub fn g() {} #[cfg(test)] mod tests { use crate::f; }"),
        ]);
        assert!(found.is_empty(), "{found:?}");
    }

    #[test]
    fn macros_and_globs_are_followed() {
        let found = cycles(&[
            ("lib.rs", "#[macro_use] mod a; mod b; pub use a::*;"),
            ("a.rs", "macro_rules! sum { () => { 0 } } pub(crate) use sum; pub use super::b::*;"),
            (
                "b.rs",
                "use super::*;
    use std::path::Path; fn f() { sum!(); }",
            ),
        ]);
        assert!(found.is_empty(), "{found:?}");
        let found = cycles(&[
            ("lib.rs", "mod a; mod b;"),
            ("a.rs", "macro_rules! sum { () => { 0 } } pub(crate) use sum; fn g() { crate::b::f(); }"),
            ("b.rs", "use super::a::*; pub fn f() { sum!(); }"),
        ]);
        assert_eq!(found, ["a.rs -> b.rs (f) -> a.rs (sum!)"]);
    }
}

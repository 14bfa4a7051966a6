//! `shaders/kernels.json`: the files of the kernels that run in other languages' packages, which read them one after the other, after
//! the constants of [`crate::kernel::text`].

use std::fmt::Write;
use std::fs;
use std::path::Path;

use crate::adjacency::ADJACENCY;
use crate::average::{self, SECOND_BUFFER, Search};
use crate::plan::{GATHER, REPAIR, TERMS, WRITE};
use crate::reals::{Arithmetic, files};
use crate::scan::SCAN;

/// Of kernels of exact arithmetic the first, which lists what it leaves.
fn kernels() -> Vec<(&'static str, Vec<&'static str>)> {
    let exact = |own| files(Arithmetic::Exact, false, own);
    vec![
        ("adjacency", ADJACENCY.to_vec()),
        ("average", average::files(Search::Adjacency, SECOND_BUFFER).to_vec()),
        ("scan", SCAN.to_vec()),
        ("terms", exact(TERMS)),
        ("gather", exact(GATHER)),
        ("repair", files(Arithmetic::Fast, true, REPAIR)),
        ("write", WRITE.to_vec()),
    ]
}

/// Names and texts of all shader files.
fn shaders() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut found = Vec::new();
    for below in ["", "items", "plan", "reals"] {
        for entry in fs::read_dir(folder.join(below)).expect("a folder of shaders") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|extension| extension == "wgsl") {
                let name = path.strip_prefix(&folder).expect("a path below").to_string_lossy().into_owned();
                found.push((name, fs::read_to_string(path).expect("a shader")));
            }
        }
    }
    found
}

/// Parts that are no files stand for themselves.
fn written() -> String {
    let shaders = shaders();
    let name = |part: &&'static str| {
        let file = shaders.iter().find(|(_, text)| text == part);
        format!("{:?}", file.map_or(*part, |(name, _)| name))
    };
    let mut json = String::from("{\n");
    for (kernel, parts) in kernels() {
        let names: Vec<_> = parts.iter().map(name).collect();
        writeln!(json, "  {kernel:?}: [{}],", names.join(", ")).expect("room");
    }
    json.truncate(json.len() - ",\n".len());
    json + "\n}\n"
}

#[test]
fn the_list_for_other_languages_is_current() {
    let expected = written();
    assert!(include_str!("../shaders/kernels.json") == expected, "shaders/kernels.json must be\n{expected}");
}

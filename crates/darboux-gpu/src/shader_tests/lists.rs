//! What packages of other languages read: `shaders/kernels.json` and `shaders/mikktspace.json` have the files of each kernel, to be read one
//! after the other, after the constants; these, and the lists of [`crate::mikktspace::passes`], `shaders/passes.json` has.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use crate::average::{self, SECOND_BUFFER, Search};
use crate::device::kernel::CONSTANTS;
use crate::device::precision::{Arithmetic, files};
use crate::device::prefix_sum::SCAN;
use crate::mikktspace::passes::{BUFFERS, Each, Kernel, OF_ADJACENCY, OF_VERTICES, Pass, Run, of_triangles};
use crate::plan::{GATHER, REPAIR, TERMS, WRITE};

type Named = (&'static str, Vec<&'static str>);

/// Of kernels of exact arithmetic the first, which lists what it leaves.
fn exact(own: &[&'static str]) -> Vec<&'static str> {
    files(Arithmetic::Exact, false, own)
}

/// For meshes that move, and the method 'average'.
fn of_moving() -> Vec<Named> {
    let mut all = of_passes(OF_ADJACENCY);
    all.extend([
        ("average", average::files(Search::Adjacency, SECOND_BUFFER).to_vec()),
        ("scan", SCAN.to_vec()),
        ("terms", exact(TERMS)),
        ("gather", exact(GATHER)),
        ("repair", files(Arithmetic::Fast, true, REPAIR)),
        ("write", WRITE.to_vec()),
    ]);
    all
}

fn of_mikktspace() -> Vec<Named> {
    let mut all = of_passes(&[OF_VERTICES, &of_triangles()].concat());
    all.push(("scan", SCAN.to_vec()));
    all
}

/// Each kernel once.
fn of_passes(passes: &[Pass]) -> Vec<Named> {
    let plain = |kernel: &Kernel| (kernel.name, kernel.files.to_vec());
    let kernels = passes.iter().flat_map(|pass| match pass {
        Pass::Clear(_) | Pass::Scan(..) => vec![],
        Pass::Run(run) => vec![plain(run.kernel)],
        Pass::Real(first, second) => {
            vec![(first.kernel.name, exact(first.kernel.files)), plain(second.kernel)]
        }
    });
    let mut found: Vec<Named> = Vec::new();
    for kernel in kernels {
        if found.iter().all(|(name, _)| *name != kernel.0) {
            found.push(kernel);
        }
    }
    found
}

/// Names and texts of all shader files.
fn shaders() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut found = Vec::new();
    for below in ["", "average", "device", "mikktspace", "plan", "precision"] {
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
fn list_of_files(kernels: Vec<Named>) -> String {
    let shaders = shaders();
    let name = |part: &&'static str| {
        let file = shaders.iter().find(|(_, text)| text == part);
        format!("{:?}", file.map_or(*part, |(name, _)| name))
    };
    let lines = kernels.iter().map(|(kernel, parts)| {
        let names: Vec<_> = parts.iter().map(name).collect();
        format!("  {kernel:?}: [{}]", names.join(", "))
    });
    format!("{{\n{}\n}}\n", lines.collect::<Vec<_>>().join(",\n"))
}

fn list_of_passes() -> String {
    let buffers =
        BUFFERS.iter().map(|(name, each, words)| format!("    {name:?}: [{}, {words}]", word(*each)));
    let list = |passes: &[Pass]| passes.iter().map(|pass| format!("    {}", json(pass))).collect::<Vec<_>>();
    let (vertices, adjacency, triangles) = (list(OF_VERTICES), list(OF_ADJACENCY), list(&of_triangles()));
    let constants = CONSTANTS.map(|(name, value)| format!("{name:?}: {value}")).join(", ");
    let mut text = format!("{{\n  \"constants\": {{ {constants} }},\n");
    write!(text, "  \"buffers\": {{\n{}\n  }}", buffers.collect::<Vec<_>>().join(",\n")).expect("room");
    for (name, passes) in [("vertices", vertices), ("adjacency", adjacency), ("triangles", triangles)] {
        write!(text, ",\n  {name:?}: [\n{}\n  ]", passes.join(",\n")).expect("room");
    }
    text + "\n}\n"
}

fn json(pass: &Pass) -> String {
    match pass {
        Pass::Clear(name) => format!("{{ \"clear\": {name:?} }}"),
        Pass::Scan(name, each) => format!("{{ \"scan\": {name:?}, \"each\": {} }}", word(*each)),
        Pass::Run(run) => format!("{{ {} }}", entry(run)),
        Pass::Real(first, second) => format!("{{ {}, \"unsure\": {{ {} }} }}", entry(first), entry(second)),
    }
}

fn entry(run: &Run) -> String {
    let buffers: Vec<_> =
        run.buffers.iter().map(|(binding, name)| format!("\"{binding}\": {name:?}")).collect();
    let (kernel, entry, each) = (run.kernel.name, run.entry, word(run.each));
    format!(
        "\"kernel\": {kernel:?}, \"entry\": {entry:?}, \"each\": {each}, \"buffers\": {{ {} }}",
        buffers.join(", ")
    )
}

fn word(each: Each) -> &'static str {
    match each {
        Each::Mesh => "\"mesh\"",
        Each::Vertex => "\"vertex\"",
        Each::Slot => "\"slot\"",
        Each::Triangle => "\"triangle\"",
        Each::Corner => "\"corner\"",
    }
}

/// With `WRITE_LISTS` in the environment the files are written.
#[test]
#[cfg_attr(small_limits, ignore = "other constants")]
fn the_lists_for_other_languages_are_current() {
    let lists = [
        ("kernels.json", list_of_files(of_moving())),
        ("mikktspace.json", list_of_files(of_mikktspace())),
        ("passes.json", list_of_passes()),
    ];
    for (name, expected) in lists {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders").join(name);
        if std::env::var_os("WRITE_LISTS").is_some() {
            fs::write(&path, &expected).expect("a folder to write to");
        }
        let found = fs::read_to_string(&path).unwrap_or_default();
        assert!(found == expected, "{} is not current: run this test with WRITE_LISTS=1", path.display());
    }
}

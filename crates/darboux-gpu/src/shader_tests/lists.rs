//! Writes and compares the lists from which the npm package runs the same kernels.
//!
//! - `shaders/kernels.json` has the files of the kernels of plans and of the methods `Average` and `Lengyel`,
//!   in the order of concatenation.
//! - `shaders/mikktspace.json` has those of MikkTSpace.
//! - `shaders/passes.json` has the constants that every shader begins with, and the lists of
//!   [`crate::mikktspace::passes`].

use std::fmt::Write;
use std::fs;
use std::path::Path;

use crate::average::{self, LENGYEL_TERMS, Search, UNIT_TERMS, WRITE_TO_BUFFER};
use crate::device::kernel::CONSTANTS;
use crate::device::precision::{Arithmetic, PassOrder, kernel_files};
use crate::device::prefix_sum::PREFIX_SUM_FILES;
use crate::mikktspace::passes::{
    ADJACENCY_PASSES, BUFFERS, Domain, Kernel, Pass, Run, VERTEX_PASSES, triangle_passes,
};
use crate::plan::shaders::{GATHER, REPAIR, TERMS, WRITE_TANGENTS};

/// The name of a kernel, and the contents of its files.
type KernelSource = (&'static str, Vec<&'static str>);

/// The first pass of a kernel of exact arithmetic.
fn exact(own: &[&'static str]) -> Vec<&'static str> {
    kernel_files(Arithmetic::Exact, PassOrder::First, own)
}

fn plan_and_average_kernels() -> Vec<KernelSource> {
    let mut all = kernels_of(ADJACENCY_PASSES);
    all.extend([
        ("average", average::shader_files(UNIT_TERMS, Search::Adjacency, WRITE_TO_BUFFER).to_vec()),
        ("lengyel", average::shader_files(LENGYEL_TERMS, Search::Adjacency, WRITE_TO_BUFFER).to_vec()),
        ("scan", PREFIX_SUM_FILES.to_vec()),
        ("terms", exact(TERMS)),
        ("gather", exact(GATHER)),
        ("repair", kernel_files(Arithmetic::Fast, PassOrder::Second, REPAIR)),
        ("write", WRITE_TANGENTS.to_vec()),
    ]);
    all
}

fn mikktspace_kernels() -> Vec<KernelSource> {
    let mut all = kernels_of(&[VERTEX_PASSES, &triangle_passes()].concat());
    all.push(("scan", PREFIX_SUM_FILES.to_vec()));
    all
}

/// The kernels of the passes, each once.
fn kernels_of(passes: &[Pass]) -> Vec<KernelSource> {
    let plain = |kernel: &Kernel| (kernel.name, kernel.files.to_vec());
    let kernels = passes.iter().flat_map(|pass| match pass {
        Pass::Clear(_) | Pass::Scan(..) => vec![],
        Pass::Run(run) => vec![plain(run.kernel)],
        Pass::RunExact(first, second) => {
            vec![(first.kernel.name, exact(first.kernel.files)), plain(second.kernel)]
        }
    });
    let mut found: Vec<KernelSource> = Vec::new();
    for kernel in kernels {
        if found.iter().all(|(name, _)| *name != kernel.0) {
            found.push(kernel);
        }
    }
    found
}

/// The names and contents of all shader files.
fn shader_files() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut found = Vec::new();
    for subfolder in ["", "average", "device", "mikktspace", "plan", "precision"] {
        for entry in fs::read_dir(folder.join(subfolder)).expect("a folder of shaders") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|extension| extension == "wgsl") {
                let name = path.strip_prefix(&folder).expect("a path below").to_string_lossy().into_owned();
                found.push((name, fs::read_to_string(path).expect("a shader")));
            }
        }
    }
    found
}

/// A part that is not a file is written as text.
fn list_of_files(kernels: Vec<KernelSource>) -> String {
    let shaders = shader_files();
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
        BUFFERS.iter().map(|(name, domain, words)| format!("    {name:?}: [{}, {words}]", word(*domain)));
    let list = |passes: &[Pass]| passes.iter().map(|pass| format!("    {}", json(pass))).collect::<Vec<_>>();
    let (vertices, adjacency, triangles) =
        (list(VERTEX_PASSES), list(ADJACENCY_PASSES), list(&triangle_passes()));
    let constants = CONSTANTS.map(|(name, value)| format!("{name:?}: {value}")).join(", ");
    let mut text = format!("{{\n  \"constants\": {{ {constants} }},\n");
    write!(text, "  \"buffers\": {{\n{}\n  }}", buffers.collect::<Vec<_>>().join(",\n")).expect("a string");
    for (name, passes) in [("vertices", vertices), ("adjacency", adjacency), ("triangles", triangles)] {
        write!(text, ",\n  {name:?}: [\n{}\n  ]", passes.join(",\n")).expect("a string");
    }
    text + "\n}\n"
}

fn json(pass: &Pass) -> String {
    match pass {
        Pass::Clear(name) => format!("{{ \"clear\": {name:?} }}"),
        Pass::Scan(name, domain) => format!("{{ \"scan\": {name:?}, \"domain\": {} }}", word(*domain)),
        Pass::Run(run) => format!("{{ {} }}", entry(run)),
        Pass::RunExact(first, second) => {
            format!("{{ {}, \"unsure\": {{ {} }} }}", entry(first), entry(second))
        }
    }
}

fn entry(run: &Run) -> String {
    let buffers: Vec<_> =
        run.buffers.iter().map(|(binding, name)| format!("\"{binding}\": {name:?}")).collect();
    let (kernel, entry, domain) = (run.kernel.name, run.entry, word(run.domain));
    format!(
        "\"kernel\": {kernel:?}, \"entry\": {entry:?}, \"domain\": {domain}, \"buffers\": {{ {} }}",
        buffers.join(", ")
    )
}

fn word(domain: Domain) -> &'static str {
    match domain {
        Domain::Mesh => "\"mesh\"",
        Domain::Vertex => "\"vertex\"",
        Domain::Slot => "\"slot\"",
        Domain::Triangle => "\"triangle\"",
        Domain::Corner => "\"corner\"",
    }
}

/// Set the environment variable `WRITE_LISTS` to write the files.
#[test]
#[cfg_attr(small_limits, ignore = "the stress build has other constants")]
fn the_lists_for_other_languages_are_current() {
    let lists = [
        ("kernels.json", list_of_files(plan_and_average_kernels())),
        ("mikktspace.json", list_of_files(mikktspace_kernels())),
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

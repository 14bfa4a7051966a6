//! Runs that the system or another process disturbs.

use std::ffi::OsString;

use crate::soak::case::{Action, Case, Content, DONE_OR_FAILED, Make, Signal};
use crate::soak::inputs::model::Mesh;
use crate::soak::random::Random;

use super::names::square_gltf;

pub const CASES: &[(&str, Make)] = &[
    ("a journal that is a FIFO", |_| Ok(journal(Content::Fifo))),
    ("a journal that leads out of the folder", |_| Ok(journal(Content::Link("../../outside".into())))),
    ("a FIFO in place of a model", |random| Ok(fifo(random))),
    ("no more threads", |random| Ok(no_threads(random))),
    ("a limit on the size of files", |random| Ok(small_files(random))),
    ("few open files", |random| Ok(few_open_files(random))),
    ("several processes in one folder", |_| Ok(together())),
    ("a run that is killed", |random| Ok(killed(random))),
];

/// Several models with buffers of their own.
fn with_models(mut case: Case, count: usize, side: u32) -> Case {
    for number in 0..count {
        case = case.file(format!("models/{number}.gltf"), square_gltf());
        case = case.file(format!("models/grid{number}.glb"), Mesh::grid(side).glb());
    }
    case
}

fn journal(content: Content) -> Case {
    let words = ["tangents", "in.glb", "--out-dir", "out", "--resume"];
    Case::new(words)
        .file("in.glb", Mesh::square(1.0).glb())
        .file("../outside", "")
        .special("out/darboux-journal.jsonl", content)
        .expects(&[1], "journal")
}

fn fifo(random: &mut Random) -> Case {
    let words: &[&str] = random.pick(&[
        &["tangents", "in.glb"],
        &["inspect", "in.glb"],
        &["compare", "in.glb", "in.glb"],
        &["convert", "in.glb", "--from", "gltf", "--to", "unity", "--raw"],
    ]);
    Case::new(words.iter().copied()).special("in.glb", Content::Fifo).expects(&[1], "regular file")
}

/// A thread whose stack is larger than the address space cannot start.
fn no_threads(random: &mut Random) -> Case {
    let words: &[&str] = random.pick(&[
        &["tangents", "models", "--out-dir", "out"],
        &["normals", "models", "--out-dir", "out", "--overwrite"],
        &[
            "convert",
            "models/grid0.glb",
            "models/0.gltf",
            "--from",
            "unity",
            "--to",
            "gltf",
            "--out-dir",
            "out",
        ],
        &["inspect", "models"],
    ]);
    let mut case = with_models(Case::new(words.iter().copied()), 3, 100);
    case.variables.push(("RUST_MIN_STACK", OsString::from((1u64 << 50).to_string())));
    case.expects(&[0], "")
}

fn small_files(random: &mut Random) -> Case {
    let words: &[&str] = random.pick(&[
        &["tangents", "models", "--out-dir", "out"],
        &["tangents", "models/grid0.glb", "-o", "out.glb"],
        &["tangents", "models/0.gltf", "--in-place"],
        &["normals", "models/grid0.glb", "--overwrite"],
    ]);
    let mut case = with_models(Case::new(words.iter().copied()), 3, 30);
    case.shell_limit = Some("ulimit -f 4");
    case.expects(DONE_OR_FAILED, "")
}

fn few_open_files(random: &mut Random) -> Case {
    let words: &[&str] = random.pick(&[
        &["tangents", "models", "--out-dir", "out"],
        &["inspect", "models"],
        &["tangents", "models", "--in-place"],
    ]);
    let mut case = with_models(Case::new(words.iter().copied()), 3, 10);
    case.shell_limit = random.pick(&[Some("ulimit -n 8"), Some("ulimit -n 12"), Some("ulimit -n 20")]);
    case
}

fn together() -> Case {
    let words = ["tangents", "models", "--out-dir", "out", "--force"];
    with_models(Case::new(words), 6, 4).with_action(Action::Together).expects(&[0], "")
}

fn killed(random: &mut Random) -> Case {
    let words: &[&str] = random.pick(&[
        &["tangents", "models", "--out-dir", "out", "--force"],
        &["tangents", "models", "--out-dir", "out", "--resume"],
        &["tangents", "models", "--in-place", "--force"],
        &["normals", "models", "--overwrite", "--out-dir", "out", "--force"],
    ]);
    let signal = random.pick(&[Signal::Interrupt, Signal::Terminate, Signal::Kill, Signal::Kill]);
    with_models(Case::new(words.iter().copied()), 8, 30).with_action(Action::Kill(signal)).expects(&[0], "")
}

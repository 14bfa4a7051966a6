//! Command lines that are wrong, and files with a part that cannot be shown.

use serde_json::{Value, json};

use crate::soak::case::{Case, Make};
use crate::soak::inputs::model::{Builder, Mesh};
use crate::soak::inputs::mutate;
use crate::soak::random::Random;

pub const CASES: &[(&str, Make)] = &[
    ("wrong values of options", |random| Ok(wrong_values(random))),
    ("a damaged job of bakes", |random| Ok(job(random))),
];

pub const OF_PICTURES: &[(&str, Make)] = &[
    ("wrong options of pictures", |random| Ok(wrong_picture(random))),
    ("points in a picture", |_| Ok(points())),
];

const USAGE: &[i32] = &[2];

fn wrong_values(random: &mut Random) -> Case {
    let words: &[&str] = random.pick(&[
        &["tangents", "in.glb", "--threshold", "nan"],
        &["tangents", "in.glb", "--jobs", "0"],
        &["tangents", "in.glb", "--method", "a\u{1b}[31m\nerror: b"],
        &["normals", "in.glb", "--normals", "crease=-1"],
        &["convert", "in.glb", "--from", "gltf,axes=1/2/3", "--to", "gltf"],
        &["compare", "in.glb"],
        &["nothing"],
    ]);
    Case::new(words.iter().copied()).file("in.glb", Mesh::square(1.0).glb()).expects(USAGE, "")
}

/// Two bakes in a TOML file, and often the journal of an earlier run, one of them damaged.
fn job(random: &mut Random) -> Case {
    let mut text = b"[defaults]\nsize = [16, 16]\nmap = [\"normal\", \"ao\"]\nao-rays = 4\n\n\
        [[bake]]\nlow = \"a.glb\"\nhigh = [\"a.glb\", \"b.glb\"]\noutput = \"a.png\"\ncage-offset = 0.5\n\n\
        [[bake]]\nlow = \"b.glb\"\nhigh = \"a.glb\"\noutput = \"b.exr\"\nback-faces = true\n"
        .to_vec();
    let mut journal = b"{\"darboux\":1}\n{\"input\":\"a.glb\",\"output\":\"a.png\"}\n".to_vec();
    let damaged = if random.one_in(4) { &mut journal } else { &mut text };
    mutate::file(random, "toml", damaged);
    // A job is a command line: exit code 2 stands for a wrong one.
    let case = Case::new(["bake", "job.toml", "--resume"])
        .expects(&[0, 1, 2], "")
        .file("job.toml", text)
        .file("a.glb", Mesh::square(1.0).glb())
        .file("b.glb", Mesh::grid(4).glb());
    if random.one_in(2) { case.file("darboux-journal.jsonl", journal) } else { case }
}

fn wrong_picture(random: &mut Random) -> Case {
    let more: &[&str] =
        random.pick(&[&["--size", "0x0"], &["--size", "1"], &["--length", "3"], &["--split", "200"]]);
    let words = ["render", "in.glb", "-o", "picture.png"].iter().chain(more).copied();
    Case::new(words).file("in.glb", Mesh::square(1.0).glb()).expects(USAGE, "")
}

fn points() -> Case {
    let mut builder = Builder::default();
    let whole = builder.primitive(&Mesh::square(1.0));
    let points = json!({ "attributes": whole["attributes"], "mode": 0 });
    Case::new(["render", "in.glb", "-o", "picture.png", "--size", "64x48"])
        .file("in.glb", builder.glb(vec![whole, points], Value::Null))
        .expects(&[0], "points")
}

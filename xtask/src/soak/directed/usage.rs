//! Command lines that are wrong, and files with a part that cannot be shown.

use serde_json::{Value, json};

use crate::soak::case::{Case, Make};
use crate::soak::inputs::model::{Builder, Mesh};
use crate::soak::random::Random;

pub const CASES: &[(&str, Make)] = &[("wrong values of options", |random| Ok(wrong_values(random)))];

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

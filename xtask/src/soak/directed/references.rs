//! Documents whose references name nothing, or something outside the folder.

use serde_json::{Value, json};

use crate::soak::case::{Case, Make};
use crate::soak::inputs::model::{Builder, Mesh};
use crate::soak::random::Random;

pub const CASES: &[(&str, Make)] = &[
    ("an accessor that does not exist yet", |random| Ok(next_accessor(random))),
    ("a broken file with nothing to do", |random| Ok(nothing_to_do(random))),
    ("a file outside the folder", |random| Ok(outside(random))),
];

const REFUSED: &[i32] = &[1];

/// A square without normals, whose UVs name the accessor that a command is about to add, or one further away.
fn next_accessor(random: &mut Random) -> Case {
    let mut builder = Builder::default();
    let mut primitive = builder.primitive(&Mesh::square(1.0));
    primitive["attributes"] = json!({ "POSITION": 0, "TEXCOORD_0": 4 + random.below(3) });
    let words: &[&str] = random.pick(&[
        &["normals", "in.glb"],
        &["tangents", "in.glb"],
        &["tangents", "in.glb", "--normals", "flat"],
        &["convert", "in.glb", "--from", "unity", "--to", "gltf"],
        &["inspect", "in.glb"],
    ]);
    Case::new(words.iter().copied())
        .file("in.glb", builder.glb(vec![primitive], Value::Null))
        .expects(REFUSED, "does not exist")
}

/// A primitive with tangents already, and one reference out of range.
fn nothing_to_do(random: &mut Random) -> Case {
    let mut builder = Builder::default();
    let mesh = Mesh::square(1.0);
    let mut primitive = builder.primitive(&mesh);
    let tangents = builder.vectors(&[[1.0, 0.0, 0.0, 1.0]; 4]);
    primitive["attributes"]["TANGENT"] = json!(tangents);
    let mut members = json!({});
    match random.below(6) {
        0 => primitive["material"] = json!(4),
        1 => primitive["attributes"]["TEXCOORD_1"] = json!(77),
        2 => members = json!({ "nodes": [{ "mesh": 3 }] }),
        3 => members = json!({ "scenes": [{ "nodes": [9] }] }),
        4 => members = json!({ "materials": [{ "normalTexture": { "index": 2 } }] }),
        _ => members = json!({ "skins": [{ "joints": [5] }] }),
    }
    let words: &[&str] = random.pick(&[
        &["tangents", "in.glb"],
        &["normals", "in.glb"],
        &["convert", "in.glb", "--from", "gltf,green=down", "--to", "gltf"],
    ]);
    Case::new(words.iter().copied())
        .file("in.glb", builder.glb(vec![primitive], members))
        .expects(REFUSED, "does not exist")
}

fn outside(random: &mut Random) -> Case {
    let mut builder = Builder::default();
    let primitive = builder.primitive(&Mesh::square(1.0));
    let mut document = builder.document(vec![primitive]);
    let uri =
        random.pick(&["../outside.bin", "../work/../outside.bin", "/etc/hostname", "%2e%2e/outside.bin"]);
    document["buffers"][0]["uri"] = json!(uri);
    Case::new(["tangents", "in.gltf"])
        .file("in.gltf", document.to_string())
        .file("../outside.bin", builder.data)
        .expects(REFUSED, "--allow-outside")
}

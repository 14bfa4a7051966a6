//! Names of files and strings in files that paths, URIs and terminals read differently.

use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::OsStrExt;
use std::path::PathBuf;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;

use crate::soak::case::{Case, Make};
use crate::soak::inputs::model::{Builder, Mesh};
use crate::soak::random::Random;

pub const CASES: &[(&str, Make)] = &[
    ("replace a model with a strange name", |random| Ok(in_place(random))),
    ("write a model under a strange name", |random| Ok(output(random))),
    ("read files with strange names", |random| Ok(input(random))),
    ("strange strings in a model", |random| Ok(strings(random))),
    ("long strings in a model", |_| Ok(long_strings())),
];

/// Names that Unix permits.
const NAMES: &[&[u8]] = &[
    b"m\xFC",
    b"a:b",
    b"a\\b",
    b"c:",
    b"https:x",
    b"tab\there",
    b"a%2fb",
    b"a#b?c",
    b" ",
    b"new\nline",
    b"\x1b[31m",
    b"error: x",
    b"\xE2\x80\xAEfdp",
    b"-",
    b"--",
    b"CON",
    b"a.b.c",
    b".hidden",
    b"...",
];

fn name(random: &mut Random, extension: &str) -> OsString {
    let mut name = OsStr::from_bytes(random.pick(NAMES)).to_os_string();
    name.push(extension);
    name
}

/// A square in one .gltf file.
pub fn square_gltf() -> String {
    let mut builder = Builder::default();
    let primitive = builder.primitive(&Mesh::square(1.0));
    let mut document = builder.document(vec![primitive]);
    let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&builder.data));
    document["buffers"] = json!([{ "byteLength": builder.data.len(), "uri": uri }]);
    document.to_string()
}

/// The path of a file in the working folder, which no option can be mistaken for.
fn here(name: &OsStr) -> PathBuf {
    PathBuf::from(".").join(name)
}

fn in_place(random: &mut Random) -> Case {
    let name = name(random, ".gltf");
    let words = [OsString::from("tangents"), "--in-place".into(), here(&name).into()];
    Case::new(words).file(name, square_gltf()).expects(&[0], "")
}

fn output(random: &mut Random) -> Case {
    let output = here(&name(random, ".gltf"));
    let words = [OsString::from("tangents"), "in.glb".into(), "-o".into(), output.into()];
    Case::new(words).file("in.glb", Mesh::square(1.0).glb()).expects(&[0], "")
}

fn input(random: &mut Random) -> Case {
    let name = name(random, ".glb");
    let command = random.pick(&["inspect", "tangents", "normals", "compare"]);
    let mut case = Case::new([OsString::from(command), here(&name).into()]);
    if command == "compare" {
        case.arguments.push(here(&name).into());
    }
    let bytes = if random.one_in(2) { Mesh::square(1.0).glb() } else { b"glTF".to_vec() };
    case.file(name, bytes)
}

/// A document in which a string has no meaning, or a meaning that must not be shown as it is.
fn strings(random: &mut Random) -> Case {
    let text = random.pick(&["\u{1b}]0;x\u{7}", "a\nerror: forged", "\u{202e}x", "a\u{1b}[2J", "\u{9b}31m"]);
    let accessor = json!({ "componentType": 5126, "count": 3, "type": text });
    let node = json!({ "name": text, "mesh": text });
    let document = match random.below(7) {
        0 => json!({ "asset": { "version": "2.0" }, "accessors": [accessor] }),
        1 => json!({ "asset": { "version": text } }),
        2 => json!({ "asset": { "version": "2.0" }, "nodes": [node] }),
        3 => json!({ "asset": { "version": "2.0" }, "buffers": [{ "byteLength": 1, "uri": text }] }),
        4 => json!({ "asset": { "version": "2.0" }, "extensionsRequired": [text] }),
        5 => {
            json!({ "asset": { "version": "2.0" }, "animations": [{ "samplers": [{ "interpolation": text }] }] })
        }
        _ => {
            json!({ "asset": { "version": "2.0" }, "meshes": [{ "name": text, "primitives": [{ "attributes": { text: 0 } }] }] })
        }
    };
    let command = random.pick(&["inspect", "tangents", "normals"]);
    Case::new([command, "in.gltf"]).file("in.gltf", document.to_string())
}

fn long_strings() -> Case {
    let accessor = json!({ "componentType": 5126, "count": 3, "type": "x".repeat(70_000) });
    let document = json!({ "asset": { "version": "2.0" }, "accessors": [accessor] });
    Case::new(["inspect", "in.gltf"]).file("in.gltf", document.to_string())
}

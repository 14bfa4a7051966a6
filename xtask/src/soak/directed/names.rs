//! Names of files and strings in files that paths, URIs and terminals read differently.

use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::OsStrExt;
use std::path::PathBuf;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;

use crate::soak::case::{Case, Make};
use crate::soak::inputs::images::BUMPS_PNG;
use crate::soak::inputs::model::{Builder, Mesh, glb};
use crate::soak::random::Random;

pub const CASES: &[(&str, Make)] = &[
    ("replace a model with a strange name", |random| Ok(in_place(random))),
    ("write a model under a strange name", |random| Ok(output(random))),
    ("read files with strange names", |random| Ok(input(random))),
    ("strange strings in a model", |random| Ok(strings(random))),
    ("long strings in a model", |random| Ok(long_strings(random))),
    ("strange names of images become files", |random| Ok(image_names(random))),
    ("maps of a folder with strange names", |random| Ok(suffixes(random))),
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

/// One of a model's strings is long, and in some cases named by many elements.
fn long_strings(random: &mut Random) -> Case {
    let text = "x".repeat(1 << (12 + random.below(9)));
    let mut builder = Builder::default();
    let mut primitive = builder.primitive(&Mesh::square(1.0));
    primitive["material"] = json!(0);
    let primitives = vec![primitive; 1 + random.below(2000)];
    let mut document = builder.document(primitives);
    document["materials"] = json!([{ "name": "m" }]);
    match random.below(7) {
        0 => document["accessors"][0]["type"] = json!(text),
        1 => document["meshes"][0]["name"] = json!(text),
        2 => document["materials"][0]["name"] = json!(text),
        3 => document["nodes"] = json!([{ "mesh": 0, "name": text }]),
        4 => document["images"] = json!([{ "uri": text }, { "uri": format!("{text}.png") }]),
        5 => document["extensionsUsed"] = json!([text]),
        _ => document["meshes"][0]["primitives"][0]["attributes"][&text] = json!(0),
    }
    let file = glb(document.to_string().as_bytes(), &builder.data);
    Case::new(line(random)).file("in.glb", file)
}

/// A command line that reads a file `in.glb`, and mostly writes what came of it.
fn line(random: &mut Random) -> Vec<&'static str> {
    let words: &[&str] = random.pick(&[
        &["inspect", "in.glb", "--json"],
        &["check", "in.glb", "--json"],
        &["check", "in.glb", "--fix", "-o", "out.gltf"],
        &["tangents", "in.glb", "--json", "-o", "out.gltf"],
        &["normals", "in.glb", "--overwrite", "-o", "out.glb"],
        &["convert", "in.glb", "--from", "gltf", "--to", "gltf", "-o", "out.obj"],
        &["convert", "in.glb", "--from", "gltf", "--to", "gltf", "-o", "out.ply"],
        &["compare", "in.glb", "in.glb", "--json"],
    ]);
    words.to_vec()
}

/// An image in the file becomes a file beside an OBJ, named after what the document calls it.
fn image_names(random: &mut Random) -> Case {
    const NAMES: [&str; 14] = [
        "..",
        ".",
        "",
        "../x",
        "../../x/..",
        "a/b",
        "C:x",
        "/absolute",
        "NUL",
        "n\0l",
        "a\nnewmtl b",
        "-bm 2",
        " ",
        "out.obj",
    ];
    let mut builder = Builder::default();
    let mut primitive = builder.primitive(&Mesh::square(1.0));
    let view = builder.view(BUMPS_PNG);
    primitive["material"] = json!(0);
    let name = random.pick(&NAMES);
    let name = if random.one_in(8) { name.repeat(1 << random.below(12)) } else { name.to_owned() };
    let members = json!({
        "materials": [{ "name": name, "normalTexture": { "index": 0 } }],
        "textures": [{ "source": 0 }],
        "images": vec![json!({ "bufferView": view, "mimeType": "image/png", "name": name }); 1 + random.below(3)],
    });
    let file = builder.glb(vec![primitive], members);
    Case::new(["convert", "in.glb", "--from", "gltf", "--to", "gltf", "-o", "out.obj"])
        .file("in.glb", file)
        .expects(&[0], "")
}

/// `bake --suffixes` on a folder of models under strange names.
fn suffixes(random: &mut Random) -> Case {
    let mut case = Case::new(["bake", "models", "--suffixes", "--size", "16", "--cage-offset", "0.1"]);
    for _ in 0..1 + random.below(3) {
        let stem = random.pick(NAMES);
        let suffixes = random.pick(&[["_low", "_high", "_cage"], ["_lp", "_HighPoly", "_cage"]]);
        for suffix in suffixes.iter().take(2 + random.below(2)) {
            let mut name = OsStr::from_bytes(stem).to_os_string();
            name.push(format!("{suffix}.glb"));
            let bytes = if random.one_in(8) { b"glTF".to_vec() } else { Mesh::grid(2).glb() };
            case = case.file(PathBuf::from("models").join(name), bytes);
        }
    }
    case.expects(&[0, 1, 2], "")
}

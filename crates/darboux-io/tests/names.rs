//! Names in a document become names of files, or are written for many elements: they neither leave the folder
//! nor fill the memory or the disk.
#![cfg(feature = "obj")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use darboux_io::gltf::Document;
use darboux_io::{LoadOptions, SaveOptions};
use serde_json::{Value, json};

/// A PNG of one texel.
const PNG: &str =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==";

/// A triangle for each material, whose base colour is an image with one of these names, embedded in the file.
fn with_images(names: &[Value]) -> Document {
    let positions: Vec<u8> =
        [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let uri = {
        use base64::Engine;
        let data = base64::engine::general_purpose::STANDARD.encode(&positions);
        format!("data:application/octet-stream;base64,{data}")
    };
    let all = |value: &dyn Fn(usize) -> Value| -> Vec<Value> { (0..names.len()).map(value).collect() };
    let gltf = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 36, "uri": uri}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"},
        ],
        "images": all(&|i| json!({"uri": format!("data:image/png;base64,{PNG}"), "name": names[i]})),
        "textures": all(&|i| json!({"source": i})),
        "materials": all(&|i| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}})),
        "meshes": [{"primitives": all(&|i| json!({"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": i}))}],
    });
    read(&gltf)
}

fn read(gltf: &Value) -> Document {
    Document::from_bytes("model", gltf.to_string().into_bytes(), None, &LoadOptions::default()).unwrap()
}

/// The names of all files below a folder.
fn files(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| {
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            if path.is_dir() {
                files(&path).into_iter().map(|file| format!("{name}/{file}")).collect()
            } else {
                vec![name]
            }
        })
        .collect()
}

#[test]
fn images_of_any_name_stay_in_the_folder_of_an_obj() {
    let outside = tempfile::tempdir().unwrap();
    let folder = outside.path().join("a/b");
    fs::create_dir_all(&folder).unwrap();
    let names = [
        json!(".."),
        json!("."),
        json!(""),
        json!("../x"),
        json!("../../x/.."),
        json!("a/b"),
        json!("C:x"),
        json!("/absolute"),
        json!("NUL"),
        json!("com1.png"),
        json!("n\0l"),
        json!("line\nnewmtl forged"),
        json!("-bm 2 x"),
        json!(" spaces "),
        json!("model.obj"),
        json!("dots..."),
        json!("x".repeat(1 << 20)),
        json!(7),
    ];
    let document = with_images(&names);
    document.save(&folder.join("model.obj"), &SaveOptions::default()).unwrap();
    let long = format!("a/b/{}.png", "x".repeat(236));
    let expected = [
        "a/b/-bm 2 x.png",
        "a/b/C_x.png",
        "a/b/NUL_.png",
        "a/b/absolute.png",
        "a/b/b.png",
        "a/b/com1_.png",
        "a/b/dots....png",
        "a/b/image_0.png",
        "a/b/image_1.png",
        "a/b/image_17.png",
        "a/b/image_2.png",
        "a/b/image_4.png",
        "a/b/line_newmtl forged.png",
        "a/b/model.mtl",
        "a/b/model.obj",
        "a/b/model.obj.png",
        "a/b/n_l.png",
        "a/b/spaces.png",
        "a/b/x.png",
        long.as_str(),
    ];
    assert_eq!(files(outside.path()), expected.map(str::to_owned).into());
    let again = Document::open(&folder.join("model.obj"), &LoadOptions::default()).unwrap();
    let materials = again.materials().unwrap();
    assert_eq!(materials.len(), names.len());
    assert!(materials.iter().all(|material| material.base_texture.is_some()), "{:?}", again.warnings());
}

#[test]
fn names_of_objects_and_materials_are_one_line_each() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["line\nv 1 2 3", "continued\\", "nul\0", "a\u{2028}b", "", "\\\\"];
    let mut gltf = with_images(&vec![json!("same"); names.len()]).json().to_string();
    gltf = gltf.replace("\"pbrMetallicRoughness\"", "\"name\":\"NAME\",\"pbrMetallicRoughness\"");
    let mut gltf: Value = serde_json::from_str(&gltf).unwrap();
    let primitives = gltf["meshes"][0]["primitives"].clone();
    gltf["meshes"] =
        (0..names.len()).map(|i| json!({"name": names[i], "primitives": [primitives[i]]})).collect();
    for (i, name) in names.iter().enumerate() {
        gltf["materials"][i]["name"] = json!(name);
    }
    let path = folder.path().join("model.obj");
    read(&gltf).save(&path, &SaveOptions::default()).unwrap();
    let again = Document::open(&path, &LoadOptions::default()).unwrap();
    let found: Vec<_> = again.meshes().iter().map(|mesh| mesh.name.as_deref().unwrap_or_default()).collect();
    assert_eq!(found, ["line v 1 2 3", "continued_", "nul", "a b", "Surface", "__"]);
    assert_eq!(again.materials().unwrap().len(), names.len());
    assert_eq!(files(folder.path()).len(), 2 + names.len(), "equal names of images are numbered");
}

/// Each surface names its object and its material: 4,000 surfaces under two names of a megabyte.
#[test]
fn long_names_are_not_written_for_every_surface() {
    let folder = tempfile::tempdir().unwrap();
    let long = ["a", "b"].map(|letter| letter.repeat(1 << 20));
    let mesh =
        |i: usize| json!({"name": long[i], "primitives": [{"attributes": {"POSITION": 0}, "material": i}]});
    let gltf = json!({
        "asset": {"version": "2.0"},
        "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3"}],
        "materials": [{"name": long[0]}, {"name": long[1]}],
        "meshes": [mesh(0), mesh(1)],
        "nodes": (0..4000).map(|i| json!({"mesh": i % 2})).collect::<Vec<_>>(),
    });
    let path = folder.path().join("model.obj");
    read(&gltf).save(&path, &SaveOptions::default()).unwrap();
    let written = fs::metadata(&path).unwrap().len();
    assert!(written < 16 << 20, "{written} bytes");
}

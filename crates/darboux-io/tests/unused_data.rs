//! Data that edits leave unused is removed, data that the input did not use is kept, and references are
//! renumbered.

mod support;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use darboux_io::gltf::{
    AddNormalsOptions, AddTangentsOptions, Document, TangentEncoding, add_normals, add_tangents,
};
use darboux_io::{LoadOptions, SaveOptions};
use serde_json::{Value, json};
use support::{BOTH, Builder, butterfly, run, run_with};

/// The JSON and the binary chunk of a GLB.
fn parts(glb: &[u8]) -> (Value, Vec<u8>) {
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    (serde_json::from_slice(&glb[20..20 + length]).unwrap(), glb[28 + length..].to_vec())
}

fn glb(document: &Document) -> (Value, Vec<u8>) {
    parts(&document.to_glb().unwrap())
}

fn list<'a>(json: &'a Value, key: &str) -> &'a [Value] {
    json[key].as_array().map_or(&[], Vec::as_slice)
}

/// The bytes that an accessor without stride shows.
fn bytes<'a>((json, chunk): &'a (Value, Vec<u8>), accessor: &Value) -> &'a [u8] {
    let accessor = &json["accessors"][accessor.as_u64().unwrap() as usize];
    let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let number = |key: &str| view[key].as_u64().unwrap_or(0) as usize;
    &chunk[number("byteOffset")..number("byteOffset") + number("byteLength")]
}

/// The accessors that primitives, and the views that accessors and images, do not name.
fn unused(json: &Value) -> (Vec<usize>, Vec<usize>) {
    let number = |value: &Value| value.as_u64().map(|number| number as usize);
    let mut accessors = BTreeSet::new();
    for primitive in list(json, "meshes").iter().flat_map(|mesh| list(mesh, "primitives")) {
        let targets = list(primitive, "targets").iter().chain([&primitive["attributes"]]);
        let attributes = targets.flat_map(|target| target.as_object().unwrap().values());
        accessors.extend(attributes.chain([&primitive["indices"]]).filter_map(number));
    }
    let images = list(json, "images").iter().filter_map(|image| number(&image["bufferView"]));
    let sparse =
        |accessor: &Value| ["indices", "values"].map(|part| number(&accessor["sparse"][part]["bufferView"]));
    let views: BTreeSet<usize> = list(json, "accessors")
        .iter()
        .flat_map(|accessor| sparse(accessor).into_iter().chain([number(&accessor["bufferView"])]).flatten())
        .chain(images)
        .collect();
    let missing =
        |used: BTreeSet<usize>, key| (0..list(json, key).len()).filter(|i| !used.contains(i)).collect();
    (missing(accessors, "accessors"), missing(views, "bufferViews"))
}

/// The butterfly, whose split replaces every accessor, behind what `first` adds and before what `last` adds.
fn split(builder: &mut Builder, more: Value) -> Document {
    let attributes = butterfly().attributes(builder);
    let mut primitive = json!({"attributes": attributes, "indices": builder.indices(&BOTH)});
    primitive.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    builder.mesh(&[primitive]);
    let mut document = std::mem::replace(builder, Builder::new()).build();
    run(&mut document);
    document
}

#[test]
fn replaced_accessors_go_with_their_views_and_bytes() {
    let document = split(&mut Builder::new(), json!({}));
    let (json, chunk) = glb(&document);
    assert_eq!(unused(&json), (vec![], vec![]));
    // Eight vertices of 48 bytes and twelve indices of two; holes are whole multiples of 16, so that a few
    // bytes may stay.
    let needed = 8 * 48 + 24;
    assert!((needed..needed + 5 * 16).contains(&chunk.len()), "{}", chunk.len());
    assert_eq!(json["buffers"][0]["byteLength"], chunk.len());
}

#[test]
fn data_that_the_input_did_not_use_is_kept() {
    let mut builder = Builder::new();
    let first = builder.vectors(&[[1.5f32, 2.5, 3.5]; 3]);
    let attributes = butterfly().attributes(&mut builder);
    let indices = builder.indices(&BOTH);
    let last = builder.vectors(&[[4.5f32, 5.5]; 3]);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let mut document = builder.build();
    run(&mut document);
    let output = glb(&document);
    assert_eq!(unused(&output.0).0, [0, 1], "accessors {first} and {last}, now in a row");
    let floats = |values: &[f32]| values.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
    assert_eq!(bytes(&output, &json!(0)), floats(&[1.5, 2.5, 3.5, 1.5, 2.5, 3.5, 1.5, 2.5, 3.5]));
    assert_eq!(bytes(&output, &json!(1)), floats(&[4.5, 5.5, 4.5, 5.5, 4.5, 5.5]));
}

#[test]
fn all_references_are_renumbered() {
    let mut builder = Builder::new();
    let attributes = butterfly().attributes(&mut builder);
    let indices = builder.indices(&BOTH);
    let mut marked = |mark: f32| builder.vectors(&[[mark; 4]; 4]);
    let [matrices, input, output, instances] = [1.0, 2.0, 3.0, 4.0].map(&mut marked);
    let outline = builder.indices(&[7, 8, 9]);
    let sparse = builder.zeros(3, "SCALAR", json!({}));
    let image = builder.vectors(&[[5.0f32; 4]]);
    builder.set("skins", json!([{"joints": [0], "inverseBindMatrices": matrices}]));
    builder.set("animations", json!([{"channels": [], "samplers": [{"input": input, "output": output}]}]));
    let instancing = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": instances}}});
    builder.set("nodes", json!([{"mesh": 0, "extensions": instancing}]));
    builder.set("images", json!([{"bufferView": image - 1, "mimeType": "image/png"}]));
    builder.mesh(&[json!({
        "attributes": attributes,
        "indices": indices,
        "extensions": {"CESIUM_primitive_outline": {"indices": outline}}
    })]);
    let mut document = builder.build();
    let before = document.to_glb().unwrap();
    run(&mut document);
    let (before, after) = (parts(&before), glb(&document));
    assert!(list(&after.0, "accessors").len() < 5 + list(&before.0, "accessors").len());
    for path in [
        "/skins/0/inverseBindMatrices",
        "/animations/0/samplers/0/input",
        "/animations/0/samplers/0/output",
        "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION",
        "/meshes/0/primitives/0/extensions/CESIUM_primitive_outline/indices",
    ] {
        let [old, new] = [&before, &after].map(|file| file.0.pointer(path).unwrap());
        assert_ne!(old, new, "{path}");
        assert_eq!(bytes(&before, old), bytes(&after, new), "{path}");
    }
    let image_of = |file: &(Value, Vec<u8>)| {
        let view = &file.0["bufferViews"][file.0["images"][0]["bufferView"].as_u64().unwrap() as usize];
        let start = view["byteOffset"].as_u64().unwrap() as usize;
        file.1[start..start + 16].to_vec()
    };
    assert_eq!(image_of(&before), image_of(&after));
    assert!(
        list(&after.0, "accessors").iter().any(|accessor| accessor.get("bufferView").is_none()),
        "{sparse}"
    );
}

#[test]
fn an_unknown_extension_keeps_the_numbers_and_is_named() {
    let mut builder = Builder::new();
    builder.set("extensions", json!({"VENDOR_lists": {"list": 3}}));
    let attributes = butterfly().attributes(&mut builder);
    let indices = builder.indices(&BOTH);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let mut document = builder.build();
    let before = glb(&document);
    let summary = run(&mut document);
    assert_eq!(summary.warnings.len(), 1, "{:?}", summary.warnings);
    assert!(summary.warnings[0].contains("VENDOR_lists"), "{:?}", summary.warnings);
    let after = glb(&document);
    let count = list(&before.0, "accessors").len();
    assert_eq!(list(&before.0, "accessors"), &list(&after.0, "accessors")[..count]);
    assert!(
        after.1.starts_with(&before.1[..before.0["buffers"][0]["byteLength"].as_u64().unwrap() as usize])
    );
}

#[test]
fn compressed_bytes_are_removed_after_decoding() {
    for name in ["draco.glb", "meshopt.glb"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/made").join(name);
        let input = parts(&std::fs::read(&path).unwrap());
        let mut document = Document::open(&path, &LoadOptions::default()).unwrap();
        add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {}).unwrap();
        let (json, chunk) = glb(&document);
        assert!(unused(&json).1.is_empty(), "{name}");
        let needed: u64 =
            list(&json, "bufferViews").iter().map(|view| view["byteLength"].as_u64().unwrap()).sum();
        let views = list(&json, "bufferViews").len() + list(&input.0, "bufferViews").len();
        assert!(chunk.len() <= needed as usize + 16 * views, "{name}: {} for {needed}", chunk.len());
    }
}

#[test]
fn files_of_buffers_without_a_use_are_not_copied() {
    let folder = tempfile::tempdir().unwrap();
    let path = gltf_with_bin(folder.path());
    let mut document = Document::open(&path, &LoadOptions::default()).unwrap();
    run(&mut document);
    let written = document.save(&folder.path().join("out/model.gltf"), &SaveOptions::default()).unwrap();
    let names: Vec<_> = written.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["model.bin", "model.gltf"]);
    let json: Value = serde_json::from_slice(&std::fs::read(written.last().unwrap()).unwrap()).unwrap();
    assert_eq!(list(&json, "buffers").len(), 1);
    assert_eq!(unused(&json), (vec![], vec![]));
}

/// A .gltf whose buffer is a file beside it.
fn gltf_with_bin(folder: &Path) -> PathBuf {
    let mut builder = Builder::new();
    let attributes = butterfly().attributes(&mut builder);
    let indices = builder.indices(&BOTH);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let (mut json, chunk) = glb(&builder.build());
    json["buffers"][0]["uri"] = json!("data.bin");
    std::fs::write(folder.join("data.bin"), &chunk).unwrap();
    let path = folder.join("model.gltf");
    std::fs::write(&path, json.to_string()).unwrap();
    path
}

/// Files are never removed: a model anywhere can use them.
#[test]
fn writing_in_place_again_and_again_adds_no_buffers() {
    let folder = tempfile::tempdir().unwrap();
    let path = gltf_with_bin(folder.path());
    let original = std::fs::read(folder.path().join("data.bin")).unwrap();
    let again = |encoding| {
        let mut document = Document::open(&path, &LoadOptions::default()).unwrap();
        let options = AddTangentsOptions::default().with_overwrite(true).with_encoding(encoding);
        run_with(&mut document, &options);
        document.save_in_place().unwrap();
        let json: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        list(&json, "buffers").len()
    };
    use TangentEncoding::{F32x4, Snorm8x4, Snorm16x4};
    let buffers = again(F32x4);
    for encoding in [F32x4, F32x4, Snorm16x4, Snorm8x4, F32x4] {
        assert_eq!(again(encoding), buffers);
    }
    assert_eq!(std::fs::read(folder.path().join("data.bin")).unwrap(), original);
    let other = folder.path().join("other.gltf");
    std::fs::copy(&path, &other).unwrap();
    again(Snorm8x4);
    Document::open(&other, &LoadOptions::default()).unwrap();
}

/// The butterfly with a morph target, and an extension that may name any accessor.
fn morphing_with_unknown_extension() -> (Value, Vec<u8>) {
    let mut builder = Builder::new();
    builder.set("extensions", json!({"VENDOR_lists": {"list": 3}}));
    let vertices = butterfly();
    let attributes = vertices.attributes(&mut builder);
    let moved: Vec<_> = vertices.positions.iter().map(|[x, y, _]| [0.0, 0.0, x * y]).collect();
    let (indices, target) = (builder.indices(&BOTH), builder.vectors(&moved));
    builder.mesh(&[json!({"attributes": attributes, "indices": indices, "targets": [{"POSITION": target}]})]);
    glb(&builder.build())
}

/// No file is written.
const NOTHING: &[PathBuf] = &[];

/// Not even where what an earlier run replaced must stay.
#[test]
fn a_second_run_in_place_changes_nothing() {
    let (mut json, chunk) = morphing_with_unknown_extension();
    let folder = tempfile::tempdir().unwrap();
    let [gltf, glb] = ["model.gltf", "model.glb"].map(|name| folder.path().join(name));
    json["buffers"][0]["uri"] = json!("data.bin");
    std::fs::write(folder.path().join("data.bin"), &chunk).unwrap();
    std::fs::write(&gltf, json.to_string()).unwrap();
    let open = |path: &Path| Document::open(path, &LoadOptions::default()).unwrap();
    std::fs::write(&glb, open(&gltf).to_glb().unwrap()).unwrap();
    let tangents = |path: &Path, encoding| {
        let mut document = open(path);
        let options = AddTangentsOptions::default().with_overwrite(true).with_encoding(encoding);
        run_with(&mut document, &options);
        document.save_in_place().unwrap()
    };
    let normals = |path: &Path| {
        let mut document = open(path);
        let options = AddNormalsOptions::default().with_overwrite(true);
        add_normals(&mut document, &options, &mut |_| {}).unwrap();
        document.save_in_place().unwrap()
    };
    for path in [&gltf, &glb] {
        for encoding in [TangentEncoding::F32x4, TangentEncoding::Snorm16x4, TangentEncoding::Snorm8x4] {
            assert!(!tangents(path, encoding).is_empty());
            assert_eq!(tangents(path, encoding), *NOTHING, "{path:?} {encoding:?}");
        }
        assert!(!normals(path).is_empty());
        assert!(!tangents(path, TangentEncoding::F32x4).is_empty(), "other normals took the tangents out");
        let before = std::fs::read(path).unwrap();
        assert_eq!(normals(path), *NOTHING, "their tangents stay");
        assert_eq!(tangents(path, TangentEncoding::F32x4), *NOTHING);
        assert_eq!(std::fs::read(path).unwrap(), before);
    }
}

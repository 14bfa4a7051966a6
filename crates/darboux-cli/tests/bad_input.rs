//! Files that the command refuses: one sentence each, no output, and the other files of the batch are
//! processed.

mod common;

use std::fs;
use std::path::Path;

use common::{asset, darboux, darboux_reading, darboux_with_little_memory, glb, names_in, text};
use serde_json::{Value, json};

/// A triangle that could get tangents: the JSON, and the buffer of 132 bytes that goes with it.
fn triangle() -> (Value, Vec<u8>) {
    let accessor = |view: usize, kind: &str| json!({ "bufferView": view, "componentType": 5126, "count": 3, "type": kind });
    let json = json!({
        "asset": { "version": "2.0" },
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 },
            "indices": 3,
        }] }],
        "accessors": [
            accessor(0, "VEC3"),
            accessor(1, "VEC3"),
            accessor(2, "VEC2"),
            { "bufferView": 3, "componentType": 5125, "count": 3, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 36 },
            { "buffer": 0, "byteOffset": 36, "byteLength": 36 },
            { "buffer": 0, "byteOffset": 72, "byteLength": 24 },
            { "buffer": 0, "byteOffset": 96, "byteLength": 12 },
        ],
        "buffers": [{ "byteLength": 108 }],
    });
    let floats: [f32; 24] = [
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, // positions
        0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, // normals
        0.0, 0.0, 1.0, 0.0, 0.0, 1.0, // UVs
    ];
    let indices = [0u32, 1, 2];
    let bytes = floats
        .iter()
        .flat_map(|float| float.to_le_bytes())
        .chain(indices.iter().flat_map(|i| i.to_le_bytes()));
    (json, bytes.collect())
}

/// The triangle as a GLB, with one place of its JSON replaced.
fn with(pointer: &str, value: Value) -> Vec<u8> {
    let (mut json, binary) = triangle();
    *json.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer} exists")) = value;
    glb(&json, &binary)
}

/// Broken files, each with a part of the sentence that must say what is wrong.
fn broken() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let (json, binary) = triangle();
    let good = glb(&json, &binary);
    let mut long = good.clone();
    long[8..12].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut chunk = good.clone();
    chunk[12..16].copy_from_slice(&0x7FFF_FFFCu32.to_le_bytes());
    let mut version = good.clone();
    version[4] = 1;
    let mut index = good.clone();
    let last = index.len() - 4;
    index[last..].copy_from_slice(&9u32.to_le_bytes());
    let deep = format!("{}{}", "[".repeat(200_000), "]".repeat(200_000));
    let attributes = "/meshes/0/primitives/0/attributes";
    let zeros = |more: Value| {
        let mut accessor = json!({ "componentType": 5126, "count": 1u64 << 40, "type": "VEC3" });
        accessor.as_object_mut().expect("an object").extend(more.as_object().expect("an object").clone());
        accessor
    };
    let places = json!({
        "count": 1u64 << 39,
        "indices": { "bufferView": 3, "componentType": 5125 },
        "values": { "bufferView": 0 },
    });
    let few = zeros(json!({ "count": 3, "sparse": places }));
    vec![
        ("empty.glb", Vec::new(), "is empty; export or download it again"),
        ("text.gltf", b"once upon a time".to_vec(), "is named as glTF, but its content"),
        ("header.glb", good[..11].to_vec(), "header.glb"),
        ("truncated.glb", good[..good.len() - 9].to_vec(), "bytes"),
        ("long.glb", long, "bytes"),
        ("chunk.glb", chunk, "chunk"),
        ("version.glb", version, "version"),
        ("syntax.gltf", b"{ \"asset\": ".to_vec(), "JSON"),
        ("deep.gltf", format!("{{ \"asset\": {deep} }}").into_bytes(), "deep.gltf"),
        ("list.gltf", b"[]".to_vec(), "list.gltf"),
        ("old.gltf", b"{ \"asset\": { \"version\": \"1.0\" } }".to_vec(), "version"),
        ("index.glb", index, "meshes[0].primitives[0]"),
        ("accessor.glb", with(&format!("{attributes}/NORMAL"), json!(77)), "77"),
        ("negative.glb", with(&format!("{attributes}/NORMAL"), json!(-1)), "NORMAL"),
        ("count.glb", with("/accessors/0/count", json!(4_000_000_000_000u64)), "accessors[0]"),
        (
            "zeros.glb",
            with("/accessors/0", zeros(json!({}))),
            "has 3 elements but there are 1099511627776 positions",
        ),
        (
            "sparse.glb",
            with("/accessors/0", zeros(json!({ "bufferView": 0, "sparse": places }))),
            "accessors[0]",
        ),
        ("places.glb", with("/accessors/0", few), "accessors[0].sparse"),
        ("overflow.glb", with("/accessors/0/count", json!(u64::MAX)), "accessors[0]"),
        ("lengths.glb", with("/accessors/1/count", json!(2)), "meshes[0].primitives[0]"),
        ("past.glb", with("/bufferViews/1/byteLength", json!(12)), "accessors[1]"),
        ("view.glb", with("/bufferViews/2/byteOffset", json!(1000)), "bufferViews[2]"),
        ("wrap.glb", with("/bufferViews/2/byteOffset", json!(u64::MAX)), "bufferViews[2]"),
        ("buffer.glb", with("/buffers/0/byteLength", json!(4_000_000_000u64)), "buffers[0]"),
        ("kind.glb", with("/accessors/0/type", json!("VEC7")), "accessors[0].type"),
        ("component.glb", with("/accessors/0/componentType", json!(5124)), "accessors[0].componentType"),
        ("shape.glb", with("/accessors/0/type", json!("VEC2")), "accessors[0]"),
        ("string.glb", with("/accessors", json!("none")), "accessors"),
        ("fraction.glb", with("/accessors/0/count", json!(2.5)), "accessors[0].count"),
        ("missing.glb", with("/buffers/0", json!({ "byteLength": 108, "uri": "gone.bin" })), "gone.bin"),
        ("above.glb", with("/buffers/0", json!({ "byteLength": 108, "uri": "../above.bin" })), "outside"),
        ("root.glb", with("/buffers/0", json!({ "byteLength": 108, "uri": "/etc/hostname" })), "outside"),
        (
            "web.glb",
            with("/buffers/0", json!({ "byteLength": 108, "uri": "https://example.com/a.bin" })),
            "another machine",
        ),
        (
            "base64.glb",
            with("/buffers/0", json!({ "byteLength": 108, "uri": "data:;base64,@@" })),
            "buffers[0]",
        ),
        (
            "material.glb",
            with("/meshes/0/primitives/0/indices", json!({})),
            "meshes[0].primitives[0].indices",
        ),
    ]
}

#[test]
fn every_broken_file_gets_one_sentence_and_no_output() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("out");
    for (name, bytes, part) in broken() {
        let path = folder.path().join(name);
        fs::write(&path, &bytes).expect("a file");
        for arguments in [&["tangents", text(&path), "--out-dir", text(&out)][..], &["inspect", text(&path)]]
        {
            let run = darboux_with_little_memory(arguments).exits(1);
            assert!(run.stdout.is_empty(), "{name}");
            assert_eq!(run.stderr.lines().count(), 1, "{name}: {}", run.stderr);
            let sentence = run.stderr.strip_prefix("error: ").expect("an error");
            assert!(sentence.starts_with(text(&path)), "{name}: {sentence}");
            assert!(sentence.contains(part), "{name}: {sentence} does not say {part}");
        }
        assert!(!out.exists(), "{name} left something in {:?}", names_in(&out));
        assert_eq!(fs::read(&path).expect("the input"), bytes, "{name} was touched");
    }
    assert_eq!(names_in(folder.path()).len(), broken().len());
}

#[test]
fn the_triangle_that_is_broken_there_is_good() {
    let (json, binary) = triangle();
    let good = glb(&json, &binary);
    let run = darboux_reading(&["tangents", "-"], &good).exits(0);
    assert_eq!(
        common::glb_json(&run.stdout)["meshes"][0]["primitives"][0]["attributes"]["TANGENT"],
        json!(4)
    );
}

#[test]
fn missing_files_and_empty_folders_are_bad_input() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for path in [folder.path().join("none.glb"), folder.path().to_path_buf()] {
        for command in ["tangents", "inspect"] {
            let run = darboux(&[command, text(&path)]).exits(1);
            assert!(run.stderr.starts_with(&format!("error: {}: ", path.display())), "{}", run.stderr);
            assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
        }
    }
}

#[test]
fn another_format_is_called_so() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let model = folder.path().join("model.max");
    fs::write(&model, b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1").expect("a file");
    for command in ["tangents", "inspect", "normals"] {
        let run = darboux(&[command, text(&model)]).exits(1);
        assert!(
            run.stderr.contains("model.max: is a scene of 3ds Max or another file of that container; export"),
            "{}",
            run.stderr
        );
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    }
}

#[test]
fn one_bad_file_does_not_stop_the_others() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let bad = folder.path().join("bad.glb");
    fs::write(&bad, b"glTF").expect("a file");
    for model in ["made/degenerate.gltf", "made/quantised-sparse.glb"] {
        fs::copy(asset(model), folder.path().join(Path::new(model).file_name().expect("a name")))
            .expect("a copy");
    }
    let run = darboux(&["tangents", text(folder.path()), "--json"]).exits(1);
    let names = [
        "bad.glb",
        "degenerate.gltf",
        "degenerate.tangents.gltf",
        "quantised-sparse.glb",
        "quantised-sparse.tangents.glb",
    ];
    let outputs: Vec<String> =
        names_in(folder.path()).into_iter().filter(|name| !name.ends_with(".bin")).collect();
    assert_eq!(outputs, names);
    let report = run.json();
    assert_eq!(report["totals"]["failed"], 1);
    assert_eq!(report["totals"]["written"], 2);
    assert_eq!(report["files"][0]["status"], "failed");
    assert!(report["files"][0]["error"].as_str().is_some_and(|error| error.starts_with(text(&bad))));
    assert_eq!(run.stderr.matches(&format!("error: {}", bad.display())).count(), 1, "{}", run.stderr);
}

#[test]
fn strict_refuses_what_is_repaired_otherwise() {
    let (json, mut binary) = triangle();
    binary[0..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let bytes = glb(&json, &binary);
    darboux_reading(&["tangents", "-"], &bytes).exits(0);
    let run = darboux_reading(&["tangents", "-", "--strict"], &bytes).exits(1);
    assert!(run.stdout.is_empty());
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    assert!(run.stderr.contains("meshes[0].primitives[0]"), "{}", run.stderr);
}

/// A pipe with a name waits for its other end, for good.
#[test]
#[cfg(unix)]
fn pipes_with_names_and_folders_are_no_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [image, model] = ["a.png", "a.glb"].map(|name| folder.path().join(name));
    for pipe in [&image, &model] {
        assert!(std::process::Command::new("mkfifo").arg(pipe).status().expect("mkfifo runs").success());
    }
    let (plane, shield) = (asset("TwoSidedPlane/TwoSidedPlane_Normal.png"), asset("made/shield.glb"));
    let convert = |path| ["convert", path, "--from", "gltf", "--to", "directx"];
    for arguments in [
        &convert(text(&image))[..],
        &convert(text(&model)),
        &["tangents", text(&model)],
        &["inspect", text(&model)],
        &["compare", text(&model), text(&model)],
        &["check", text(&image)],
        &["check", text(&model)],
        &["check", text(&plane), "--model", text(&model)],
        &[
            "bake",
            text(&shield),
            "--high",
            text(&shield),
            "--size",
            "8",
            "--skew",
            text(&image),
            "-o",
            "never.png",
        ],
    ] {
        let run = darboux(arguments).exits(1);
        assert!(run.stderr.contains("not a regular file"), "{arguments:?}: {}", run.stderr);
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    }
    let arguments = ["--from", "gltf", "--to", "directx", "--force", "-o", text(&image)];
    let run = darboux(&[&["convert", text(&plane)], &arguments[..]].concat()).exits(1);
    assert!(run.stderr.contains("not a regular file"), "{}", run.stderr);
    let run = darboux_reading(&["inspect", "/dev/stdin"], b"glTF").exits(1);
    assert!(
        run.stderr.contains("/dev/stdin: is not a regular file; ") && run.stderr.contains(" to -"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_folder_in_place_of_a_model_gets_one_sentence() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (model, picture) = (asset("Fox/Fox.glb"), folder.path().join("a.png"));
    let place = text(folder.path());
    for arguments in [
        &["compare", place, text(&model)][..],
        &["compare", text(&model), place],
        &["compare", place, "--method", "area"],
        &["render", place, "-o", text(&picture)],
        &["view", place, "--no-open"],
    ] {
        let run = darboux(arguments).exits(1);
        let sentence = format!("error: {place}: cannot be read: it is a folder; name a file in it\n");
        assert_eq!(run.stderr, sentence, "{arguments:?}");
    }
}

/// The file that the user named, not the one that stands for it until it is whole.
#[test]
#[cfg(target_os = "linux")]
fn an_output_that_cannot_be_made_is_called_by_its_name() {
    let model = asset("made/quantised-sparse.glb");
    let run = darboux(&["tangents", text(&model), "-o", "/proc/model.glb"]).exits(1);
    assert!(run.stderr.starts_with("error: /proc/model.glb: cannot be written: "), "{}", run.stderr);
    assert!(!run.stderr.contains(".darboux-"), "{}", run.stderr);
}

/// A mistyped folder is not made; nothing is read or written.
#[test]
fn named_outputs_go_into_folders_that_exist() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (model, missing) = (asset("made/quantised-sparse.glb"), folder.path().join("mistyped"));
    let [glb, png] = ["a.glb", "a.png"].map(|name| missing.join(name));
    for arguments in [
        &["tangents", text(&model), "-o", text(&glb)][..],
        &["compare", text(&model), "--method", "area", "--heat-map", text(&png)],
        &["render", text(&model), "-o", text(&png)],
    ] {
        let run = darboux(arguments).exits(2);
        assert!(
            run.stderr.contains(&format!("the folder {} does not exist; ", missing.display())),
            "{}",
            run.stderr
        );
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    }
    assert!(!missing.exists());
    darboux(&["tangents", text(&model), "--out-dir", text(&missing)]).exits(0);
    assert_eq!(names_in(&missing), ["quantised-sparse.glb"]);
}

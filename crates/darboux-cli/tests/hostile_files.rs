//! Small files that ask for much time or memory, and references to nothing: each is refused by one sentence,
//! and nothing is left.
//!
//! Where the system can limit memory, the command runs with 256 MiB and four times the file of addresses, so
//! that a large allocation ends it.

mod common;

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use common::{
    asset, darboux, darboux_with, darboux_with_addresses, folder_with, glb, has_adapter, names_in, program,
    text,
};
use serde_json::{Value, json};

/// A square of two triangles with normals and UVs: the JSON, and its buffer.
fn square() -> (Value, Vec<u8>) {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0f32]];
    let positions = corners.iter().flat_map(|&[x, y]| [x, y, 0.0]);
    let normals = corners.iter().flat_map(|_| [0.0, 0.0, 1.0]);
    let floats = positions.chain(normals).chain(corners.into_iter().flatten());
    let indices = [0u32, 1, 2, 0, 2, 3];
    let bytes =
        floats.flat_map(f32::to_le_bytes).chain(indices.iter().flat_map(|i| i.to_le_bytes())).collect();
    let view =
        |start: usize, length: usize| json!({ "buffer": 0, "byteOffset": start, "byteLength": length });
    let floats =
        |view: usize, kind| json!({ "bufferView": view, "componentType": 5126, "count": 4, "type": kind });
    let indices = json!({ "bufferView": 3, "componentType": 5125, "count": 6, "type": "SCALAR" });
    let json = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": 152 }],
        "bufferViews": [view(0, 48), view(48, 48), view(96, 32), view(128, 24)],
        "accessors": [floats(0, "VEC3"), floats(1, "VEC3"), floats(2, "VEC2"), indices],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 },
            "indices": 3,
        }] }],
    });
    (json, bytes)
}

/// Runs the command on a file that is alone in its folder. It must refuse the file by one sentence with this
/// part, and leave the folder as it was.
#[track_caller]
fn refused(name: &str, bytes: &[u8], words: &[&str], part: &str) {
    refused_with_addresses((256 << 20) + 4 * bytes.len(), name, bytes, words, part);
}

/// As [`refused`], with this many bytes of addresses.
fn refused_with_addresses(addresses: usize, name: &str, bytes: &[u8], words: &[&str], part: &str) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    fs::write(&path, bytes).expect("a file");
    let mut arguments = vec![words[0], text(&path)];
    let out = folder.path().join("out.png");
    arguments.extend(words[1..].iter().map(|&word| if word == "OUT" { text(&out) } else { word }));
    let run = darboux_with_addresses(addresses, &arguments).exits(1);
    assert!(run.stdout.is_empty(), "{words:?}");
    assert!(run.stderr.starts_with(&format!("error: {}: ", path.display())), "{words:?}: {}", run.stderr);
    assert!(run.stderr.lines().count() == 1 && run.stderr.contains(part), "{words:?}: {}", run.stderr);
    assert!(run.stderr.contains("; "), "{words:?} does not say what to do: {}", run.stderr);
    assert_eq!(names_in(folder.path()), [name], "{words:?}");
    assert_eq!(fs::read(&path).expect("the input"), bytes, "{words:?}");
}

#[test]
fn accessors_that_a_command_is_about_to_add_are_no_references() {
    let (mut json, binary) = square();
    for missing in [4, 5, 99] {
        json["meshes"][0]["primitives"][0]["attributes"] = json!({ "POSITION": 0, "TEXCOORD_0": missing });
        for words in [
            &["normals"][..],
            &["tangents"],
            &["tangents", "--normals", "flat"],
            &["convert", "--from", "unity", "--to", "gltf"],
            &["inspect"],
        ] {
            let part = format!("TEXCOORD_0: accessor {missing} does not exist");
            refused("model.glb", &glb(&json, &binary), words, &part);
        }
    }
}

#[test]
fn broken_references_are_found_where_there_is_nothing_to_do() {
    let (good, binary) = square();
    let with = |pointer: &str, key: &str, value: Value| {
        let mut json = good.clone();
        json.pointer_mut(pointer).expect("an object")[key] = value;
        glb(&json, &binary)
    };
    let primitive = "/meshes/0/primitives/0";
    for (file, part) in [
        (with(&format!("{primitive}/attributes"), "TANGENT", json!(7)), "accessor 7 does not exist"),
        (with(primitive, "indices", json!(9)), "accessor 9 does not exist"),
        (with("/accessors/1", "count", json!(3)), "NORMAL: has 3 elements but there are 4 positions"),
        (with("/accessors/3", "count", json!(60)), "accessors[3]: 60 elements of 4 bytes"),
        (with("/bufferViews/3", "byteOffset", json!(150)), "bufferViews[3]: 24 bytes from byte 150"),
        (with(primitive, "material", json!(4)), "does not exist"),
        (with("", "nodes", json!([{ "mesh": 3 }])), "does not exist"),
        (with("", "skins", json!([{ "joints": [5] }])), "does not exist"),
    ] {
        for words in [
            &["tangents"][..],
            &["normals"],
            &["convert", "--from", "gltf,green=down", "--to", "gltf"],
            &["inspect"],
        ] {
            refused("model.glb", &file, words, part);
        }
    }
}

/// Every command refuses at opening what another one would refuse, so that none writes a file that another
/// one cannot read.
#[test]
fn every_command_refuses_modes_that_do_not_exist() {
    for mode in [7, 65535] {
        let (mut json, binary) = square();
        json["nodes"] = json!([{ "mesh": 0 }]);
        let primitives = json["meshes"][0]["primitives"].as_array_mut().expect("primitives");
        let mut other = primitives[0].clone();
        other["mode"] = mode.into();
        primitives.push(other);
        let file = glb(&json, &binary);
        let high = asset("made/shield.glb");
        for words in [
            &["tangents"][..],
            &["normals"],
            &["convert", "--from", "unity", "--to", "gltf"],
            &["check"],
            &["check", "--fix"],
            &["inspect"],
            &["compare", text(&high)],
            &["bake", "--high", text(&high), "--size", "16", "-o", "OUT"],
        ] {
            let part = format!("meshes[0].primitives[1].mode: {mode} is not a mode; use 0 to 6");
            refused("model.glb", &file, words, &part);
        }
    }
}

/// Also where only attributes are converted, or faces reversed.
#[test]
fn models_with_indices_of_no_vertex_are_not_converted() {
    let (json, mut binary) = square();
    binary[128] = 9;
    let file = glb(&json, &binary);
    for from in ["unity", "directx", "blender"] {
        let words = ["convert", "--from", from, "--to", "gltf"];
        refused("model.glb", &file, &words, "index 9 at place 0 is out of range");
    }
}

/// A model written under any name is one that this command can read again.
#[test]
#[cfg(unix)]
fn models_under_names_that_uris_cannot_spell_stay_readable() {
    use std::ffi::{OsStr, OsString};
    use std::os::unix::ffi::OsStrExt;

    for name in [&b"m\xFC.gltf"[..], b"a:b.gltf", b"a\\b.gltf", b"ok.gltf"] {
        let folder = folder_with(&["made/degenerate.gltf"]);
        let model = folder.path().join(OsStr::from_bytes(name));
        fs::rename(folder.path().join("degenerate.gltf"), &model).expect("a new name");
        let words = |words: &[&str]| -> Vec<OsString> {
            words.iter().map(OsString::from).chain([model.clone().into()]).collect()
        };
        let before = fs::read(&model).expect("the model");
        darboux(&words(&["tangents", "--in-place"])).exits(0);
        assert_ne!(fs::read(&model).expect("the model"), before, "{name:?}");
        darboux(&words(&["inspect", "--quiet"])).exits(0);
    }
}

/// A PNG of zeros with 16 bits per channel. Its zlib stream has no end, which does not matter: the file is
/// refused by its size.
fn flat_png(side: u32, texels: usize) -> Vec<u8> {
    let header = [&side.to_be_bytes()[..], &side.to_be_bytes(), &[16, 6, 0, 0, 0]].concat();
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    for (kind, content) in [(b"IHDR", header), (b"IDAT", vec![0; texels]), (b"IEND", Vec::new())] {
        file.extend((content.len() as u32).to_be_bytes());
        let chunk = [&kind[..], &content].concat();
        file.extend(&chunk);
        file.extend(crc32(&chunk).to_be_bytes());
    }
    file
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xEDB8_8320 & 0u32.wrapping_sub(crc & 1)))
    })
}

#[test]
fn images_much_larger_than_their_files_are_refused() {
    let file = flat_png(16_000, 2_000_000);
    refused(
        "flat.png",
        &file,
        &["convert", "--from", "gltf", "--to", "directx"],
        "raise the limit (--memory-limit)",
    );
}

/// Strips whose indices are parts of one list, each one index further.
fn strips() -> Vec<u8> {
    let (mut json, mut binary) = square();
    let (count, length) = (1200, 500_000);
    let bytes = 4 * (count + length);
    json["bufferViews"][3]["byteLength"] = json!(bytes);
    json["buffers"][0]["byteLength"] = json!(128 + bytes);
    binary.resize(128 + bytes, 0);
    let mut accessors = json["accessors"].as_array().expect("a list").clone();
    let mut strip = json["meshes"][0]["primitives"][0].clone();
    strip["mode"] = json!(5);
    let strips: Vec<Value> = (0..count)
        .map(|number| {
            strip["indices"] = json!(accessors.len());
            accessors.push(json!({
                "bufferView": 3, "byteOffset": 4 * number, "componentType": 5125, "count": length, "type": "SCALAR",
            }));
            strip.clone()
        })
        .collect();
    json["meshes"][0]["primitives"] = json!(strips);
    json["accessors"] = json!(accessors);
    glb(&json, &binary)
}

#[test]
fn strips_over_the_same_bytes_are_refused() {
    let file = strips();
    for words in [&["normals", "--overwrite"][..], &["tangents"], &["inspect"]] {
        refused("strips.glb", &file, words, "raise the limit (--memory-limit)");
    }
}

/// Missing memory is one sentence where the limit was raised beyond the memory, and where the process has
/// less than a file needs.
#[test]
#[cfg(target_os = "linux")]
fn missing_memory_is_one_sentence() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.glb");
    fs::write(&path, strips()).expect("a file");
    for words in [&["normals", "--overwrite"][..], &["tangents"], &["inspect"]] {
        let arguments = [&[words[0], text(&path), "--memory-limit", "1000000"], &words[1..]].concat();
        let run = darboux_with_addresses(256 << 20, &arguments).exits(1);
        assert!(run.stderr.starts_with("error: there is not enough memory; "), "{}", run.stderr);
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
        assert_eq!(names_in(folder.path()), ["a.glb"]);
    }
}

/// The batch goes on after a file that was refused; one that ended two runs is named, and the others are
/// done.
#[test]
#[cfg(target_os = "linux")]
fn a_batch_goes_on_beside_a_file_that_needs_too_much_memory() {
    let folder = folder_with(&["made/shield.glb", "made/quantised-sparse.glb"]);
    fs::write(folder.path().join("deadly.glb"), strips()).expect("a file");
    let out = tempfile::tempdir().expect("a temporary folder");
    let run = |options: &[&str]| {
        let fixed = ["tangents", text(folder.path()), "--jobs", "1", "--out-dir"];
        let arguments = [&fixed[..], &[text(out.path())], options].concat();
        darboux_with_addresses(256 << 20, &arguments).exits(1).stderr
    };
    let said = run(&["--resume"]);
    assert!(said.contains("deadly.glb: ") && said.contains("in 2 files, 1 file failed"), "{said}");
    let raised = ["--resume", "--memory-limit", "1000000"];
    for _ in 0..2 {
        let said = run(&raised);
        assert!(said.contains("error: there is not enough memory; "), "{said}");
    }
    for _ in 0..2 {
        let said = run(&raised);
        assert!(
            said.contains("deadly.glb: is skipped")
                && said.contains("in 0 files, 2 files were up to date, 1 file failed"),
            "{said}"
        );
    }
    let said = run(&["--resume", "--retry"]);
    assert!(said.contains("more than the memory limit of"), "{said}");
}

/// Every view names the same stream of half a megabyte, which is all zero after its first byte and decodes to
/// 32 MiB.
#[test]
fn views_over_one_compressed_stream_are_refused() {
    let (count, views) = (8 << 20, 31);
    let mut stream = vec![0; 1 + 16 * (count / 256) + 32];
    stream[0] = 0xA0;
    let view = |i: usize| {
        let compressed = json!({
            "buffer": 0, "byteLength": stream.len(), "byteStride": 4, "count": count, "mode": "ATTRIBUTES",
        });
        let extensions = json!({ "EXT_meshopt_compression": compressed });
        json!({ "buffer": 1, "byteOffset": i * 4 * count, "byteLength": 4 * count, "extensions": extensions })
    };
    let accessor = |i: usize| {
        let kind = ["VEC3", "VEC3", "VEC2"][i % 3];
        json!({ "bufferView": i, "componentType": 5120, "normalized": true, "count": 999, "type": kind })
    };
    let json = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": stream.len() }, { "byteLength": views * 4 * count }],
        "bufferViews": (0..views).map(view).collect::<Vec<_>>(),
        "accessors": (0..3).map(accessor).collect::<Vec<_>>(),
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 } }] }],
    });
    let file = glb(&json, &stream);
    for words in [&["tangents"][..], &["normals", "--overwrite"], &["inspect"]] {
        refused("views.glb", &file, words, "raise the limit (--memory-limit)");
    }
}

#[test]
fn lists_of_empty_primitives_are_refused() {
    let primitives = vec![r#"{"attributes":{}}"#; 550_000].join(",");
    let file = format!(r#"{{"asset":{{"version":"2.0"}},"meshes":[{{"primitives":[{primitives}]}}]}}"#);
    for words in [&["tangents"][..], &["normals"], &["inspect"]] {
        // A JSON value takes more memory than its text, within the memory limit.
        let addresses = (256 << 20) + 64 * file.len();
        let part = "has 550000 primitives, which need more than the memory limit";
        refused_with_addresses(addresses, "many.gltf", file.as_bytes(), words, part);
    }
    // Values take less memory than the default limit, but not less than a process may have.
    let objects = r#"{"":0},"#.repeat(4_000_000);
    let file = format!(r#"{{"asset":{{"version":"2.0"}},"extras":[{objects}0]}}"#);
    let part = "has JSON that needs more than the memory limit of";
    refused_with_addresses(600 << 20, "objects.gltf", file.as_bytes(), &["tangents"], part);
}

#[test]
fn objs_of_many_objects_are_refused() {
    let objects: String = (0..100_000).map(|i| format!("o {i}\nf 1 1 1\n")).collect();
    let file = format!("v 0 0 0\n{objects}");
    refused("many.obj", file.as_bytes(), &["render", "-o", "OUT"], "has 100000 objects and groups");
}

/// Each of 2,000 lines names a library of 1,000 lines, which is read once.
#[test]
fn an_obj_that_names_one_library_often_is_drawn() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: String| fs::write(folder.path().join(name), text).expect("a file");
    write("a.obj", "mtllib a.mtl\n".repeat(2000) + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("a.mtl", format!("newmtl a\n{}", "map_Kd x.png\n".repeat(1000)));
    let picture = folder.path().join("a.png");
    let model = folder.path().join("a.obj");
    let run = darboux(&["render", text(&model), "-o", text(&picture), "--size", "64x48"]).exits(0);
    assert_eq!(run.stderr.matches("warning: ").count(), 1, "{}", run.stderr);
    assert!(picture.exists());
}

/// Draws a model; returns the standard error.
fn drawn(file: &[u8], code: i32) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [model, picture] = ["a.glb", "a.png"].map(|name| folder.path().join(name));
    fs::write(&model, file).expect("a file");
    let run = darboux(&["render", text(&model), "-o", text(&picture), "--size", "64x48"]).exits(code);
    assert_eq!(picture.exists(), code == 0);
    run.stderr
}

#[test]
fn textures_much_larger_than_their_files_are_left_out() {
    if !has_adapter() {
        return;
    }
    let (mut json, mut binary) = square();
    let image = flat_png(8000, 1000);
    let view = json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": image.len() });
    json["bufferViews"].as_array_mut().expect("a list").push(view);
    binary.extend(&image);
    json["buffers"][0]["byteLength"] = json!(binary.len());
    json["images"] = json!([{ "bufferView": 4, "mimeType": "image/png" }]);
    json["textures"] = json!([{ "source": 0 }]);
    json["materials"] = json!([{ "normalTexture": { "index": 0 } }]);
    json["meshes"][0]["primitives"][0]["material"] = json!(0);
    json["nodes"] = json!([{ "mesh": 0 }]);
    let said = drawn(&glb(&json, &binary), 0);
    assert!(
        said.contains("warning: ") && said.contains("images[0] has 8000 x 8000 texels, more than the limit"),
        "{said}"
    );
    assert!(said.contains("raise the memory limit"), "{said}");
}

/// Software adapters keep every triangle of a picture in memory.
#[test]
fn scenes_of_many_triangles_are_refused_by_software_adapters() {
    let report = darboux(&["devices", "--json"]).exits(0).json();
    let adapters = report["adapters"].as_array().expect("a list");
    if !has_adapter() || adapters.iter().any(|adapter| adapter["kind"] != "software") {
        return;
    }
    let (mut json, mut binary) = square();
    binary.resize(128 + 4 * 900, 0);
    json["bufferViews"][3]["byteLength"] = json!(4 * 900);
    json["buffers"][0]["byteLength"] = json!(binary.len());
    json["accessors"][3]["count"] = json!(900);
    json["nodes"] = json!(vec![json!({ "mesh": 0 }); 30_000]);
    let said = drawn(&glb(&json, &binary), 1);
    assert!(said.contains("its scene has 9000000 triangles, more than the limit of 8388608"), "{said}");
}

/// The files of a folder with their contents.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let read = |name: String| (name.clone(), fs::read(folder.join(&name)).expect("a file"));
    names_in(folder).into_iter().map(read).collect()
}

/// A file that grows beyond `ulimit -f` gets a signal that ends the process, or an error where the signal is
/// ignored.
#[test]
#[cfg(unix)]
fn a_limit_on_the_size_of_files_leaves_nothing() {
    use std::os::unix::process::ExitStatusExt;
    use std::process::Command;

    for arguments in [&["-o", "OUT"][..], &["--in-place", "--overwrite"], &["--out-dir", "OUT"]] {
        let folder = folder_with(&["made/shield.glb"]);
        let model = folder.path().join("shield.glb");
        let out = folder.path().join("out.glb");
        let before = contents(folder.path());
        let arguments = arguments.iter().map(|&word| if word == "OUT" { text(&out) } else { word });
        let output = Command::new("sh")
            .args([
                "-c",
                "ulimit -f 8 && exec \"$0\" \"$@\"",
                env!("CARGO_BIN_EXE_darboux"),
                "tangents",
                text(&model),
            ])
            .args(arguments)
            .output()
            .expect("a shell");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!((output.status.code(), output.status.signal()), (Some(1), None), "{stderr}");
        assert!(stderr.starts_with("error: ") && stderr.lines().count() == 1, "{stderr}");
        assert!(stderr.contains("cannot be written: "), "{stderr}");
        assert!(contents(folder.path()) == before, "{:?}", names_in(folder.path()));
    }
}

/// As under `ulimit -u`: a thread whose stack is larger than the address space cannot start.
#[test]
#[cfg(target_pointer_width = "64")]
fn without_threads_the_results_are_the_same() {
    let models = folder_with(&["made/shield.glb", "NormalTangentTest/NormalTangentTest.glb", "Fox/Fox.glb"]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let stack = (1u64 << 50).to_string();
    let [with, without] = ["with", "without"].map(|name| folder.path().join(name));
    for command in [&["tangents", "--overwrite"][..], &["normals", "--overwrite"]] {
        let words = |out| [command, &[text(models.path()), "--out-dir", out, "--force"]].concat();
        darboux(&words(text(&with))).exits(0);
        let run = darboux_with(&[("RUST_MIN_STACK", &stack)], &words(text(&without))).exits(0);
        assert!(!run.stderr.contains("error: ") && !run.stderr.contains("panicked"), "{}", run.stderr);
        assert!(contents(&with) == contents(&without), "{command:?}");
    }
    for words in [&["inspect", text(models.path())][..], &["methods"]] {
        assert_eq!(
            darboux_with(&[("RUST_MIN_STACK", &stack)], words).exits(0).stdout,
            darboux(words).exits(0).stdout
        );
    }
}

/// A grid of `side` by `side` squares with normals and UVs, which takes a while.
fn grid(side: u32) -> Vec<u8> {
    let vertices = (0..=side).flat_map(|i| (0..=side).map(move |j| [i as f32, j as f32]));
    let vertices: Vec<[f32; 2]> = vertices.map(|place| place.map(|x| x / side as f32)).collect();
    let of_square = |i: u32, j: u32| {
        let [a, b] = [0, 1].map(|next| (i + next) * (side + 1) + j);
        [a, b, b + 1, a, b + 1, a + 1]
    };
    let indices: Vec<u32> = (0..side).flat_map(|i| (0..side).flat_map(move |j| of_square(i, j))).collect();
    let positions = vertices.iter().flat_map(|&[x, y]| [x, y, 0.0]);
    let normals = vertices.iter().flat_map(|_| [0.0, 0.0, 1.0]);
    let floats = positions.chain(normals).chain(vertices.iter().flatten().copied());
    let bytes: Vec<u8> =
        floats.flat_map(f32::to_le_bytes).chain(indices.iter().flat_map(|i| i.to_le_bytes())).collect();
    let (mut json, _) = square();
    let count = vertices.len();
    let lengths = [12 * count, 12 * count, 8 * count, 4 * indices.len()];
    for (view, length) in lengths.iter().enumerate() {
        let start: usize = lengths[..view].iter().sum();
        json["bufferViews"][view] = json!({ "buffer": 0, "byteOffset": start, "byteLength": length });
        json["accessors"][view]["count"] = json!(if view == 3 { indices.len() } else { count });
    }
    json["buffers"][0]["byteLength"] = json!(bytes.len());
    glb(&json, &bytes)
}

/// Another program empties a model while the command works on it, at several moments.
#[test]
fn a_file_that_is_shortened_meanwhile_does_not_end_the_batch() {
    let model = grid(200);
    for moment in [2, 5, 10, 15, 20, 30, 40, 60] {
        let folder = folder_with(&["made/shield.glb"]);
        let path = folder.path().join("a.glb");
        fs::write(&path, &model).expect("a model");
        let mut command = program();
        command.args(["tangents", "a.glb", "shield.glb", "--jobs", "1", "--out-dir", "out"]);
        let child =
            command.current_dir(folder.path()).stderr(Stdio::piped()).spawn().expect("the command starts");
        std::thread::sleep(Duration::from_millis(moment));
        let file = fs::File::options().write(true).open(&path).expect("the model");
        file.set_len(4096).expect("a shorter model");
        let output = child.wait_with_output().expect("the command ends");
        let told = String::from_utf8_lossy(&output.stderr);
        let expected = match output.status.code() {
            Some(0) => vec!["a.glb", "shield.glb"],
            Some(1) => vec!["shield.glb"],
            other => panic!("after {moment} ms: {other:?}, {told}"),
        };
        assert_eq!(names_in(&folder.path().join("out")), expected, "after {moment} ms: {told}");
    }
}

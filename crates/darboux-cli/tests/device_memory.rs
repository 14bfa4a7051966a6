//! `darboux tangents` on a device whose memory ends.
#![cfg(target_os = "linux")]

mod common;

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use common::{darboux, program, text};
use serde_json::json;

/// Writes a model of a wavy square of `side` by `side` quads.
fn write_square(path: &Path, side: u32) {
    let at = |k: u32| k as f32 / side as f32;
    let places = || (0..=side).flat_map(|y| (0..=side).map(move |x| (x, y)));
    let floats: [Vec<f32>; 3] = [
        places().flat_map(|(x, y)| [at(x), at(y), 0.02 * ((x + 3 * y) % 5) as f32]).collect(),
        places().flat_map(|_| [0.0, 0.0, 1.0]).collect(),
        places().flat_map(|(x, y)| [at(x), at(y)]).collect(),
    ];
    let quads = (0..side).flat_map(|y| (0..side).map(move |x| y * (side + 1) + x));
    let indices: Vec<u32> =
        quads.flat_map(|a| [a, a + 1, a + side + 2, a, a + side + 2, a + side + 1]).collect();
    let bytes = |words: Vec<u32>| words.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<u8>>();
    let [positions, normals, uvs] = floats.map(|list| bytes(list.into_iter().map(f32::to_bits).collect()));
    let parts = [positions, normals, uvs, bytes(indices.clone())];
    let mut start = 0;
    let views = parts.each_ref().map(|part| {
        start += part.len();
        json!({ "buffer": 0, "byteOffset": start - part.len(), "byteLength": part.len() })
    });
    let count = (side + 1) * (side + 1);
    let floats =
        |view: u32, kind| json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind });
    let mut accessors = vec![floats(0, "VEC3"), floats(1, "VEC3"), floats(2, "VEC2")];
    (accessors[0]["min"], accessors[0]["max"]) = (json!([0, 0, 0]), json!([1, 1, 1]));
    accessors
        .push(json!({ "bufferView": 3, "componentType": 5125, "count": indices.len(), "type": "SCALAR" }));
    let attributes = json!({ "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 });
    let name = path.with_extension("bin");
    let model = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "uri": name.file_name().expect("a name").to_str(), "byteLength": start }],
        "bufferViews": views,
        "accessors": accessors,
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": 3 }] }],
    });
    fs::write(&name, parts.concat()).expect("a file");
    fs::write(path, model.to_string()).expect("a file");
}

/// Runs the command on small models and then on a large one, for which the device has too little memory. The
/// limit is set after all shaders are compiled, when the first small model is done.
fn in_little_memory(device: &str, folder: &Path) -> Output {
    let (input, out) = (folder.join("in"), folder.join(device));
    let mut command = program();
    command.args([
        "tangents",
        text(&input),
        "--out-dir",
        text(&out),
        "--overwrite",
        "--verbose",
        "--device",
        device,
    ]);
    command.env("DARBOUX_GPU_TRIANGLES", "1").stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the command starts");
    let id = child.id().to_string();
    let tell = |signal: &str| {
        Command::new("kill").args([signal, id.as_str()]).status().is_ok_and(|status| status.success())
    };
    while child.try_wait().expect("a child").is_none() && !out.join("00.gltf").exists() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    assert!(tell("-STOP"));
    assert!(!out.join("last.gltf").exists());
    let status = fs::read_to_string(format!("/proc/{id}/status")).expect("Linux");
    let size = status.lines().find_map(|line| line.strip_prefix("VmSize:")?.trim().strip_suffix(" kB"));
    let size: u64 = size.and_then(|size| size.trim().parse().ok()).expect("a size");
    // Between what the CPU needs for the large model and what the device does, twice as much and half as
    // much.
    let limit = format!("--as={}", 1024 * size + (150 << 20));
    let limited = Command::new("prlimit").args([format!("--pid={id}"), limit]).status();
    assert!(limited.is_ok_and(|status| status.success()));
    assert!(tell("-CONT"));
    child.wait_with_output().expect("the command ends")
}

/// Whether the only adapter is software, and processes can be limited: a real GPU has memory of its own.
fn is_memory_ours() -> bool {
    let report = darboux(&["devices", "--json"]).exits(0).json();
    let adapters = report["adapters"].as_array().expect("a list");
    let name =
        |adapter: &serde_json::Value| adapter["name"].as_str().is_some_and(|name| name.contains("llvmpipe"));
    let prlimit = Command::new("prlimit").arg("--version").output();
    adapters.len() == 1 && adapters.iter().all(name) && prlimit.is_ok_and(|output| output.status.success())
}

#[test]
fn out_of_memory_the_cpu_takes_over_unless_a_gpu_is_asked_for() {
    if !is_memory_ours() {
        let why = "skipped: no adapter whose memory is this machine's, or no prlimit (Debian: util-linux)";
        writeln!(std::io::stdout(), "{why}").expect("standard output");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let input = folder.path().join("in");
    fs::create_dir(&input).expect("a folder");
    (0..40).for_each(|k| write_square(&input.join(format!("{k:02}.gltf")), 4));
    write_square(&input.join("last.gltf"), 500);
    let why = "the GPU does not have enough memory for this mesh";
    for (device, code, expected) in [
        ("gpu", 1, format!("last.gltf: meshes[0].primitives[0]: {why}")),
        ("auto", 0, format!("last.gltf: the CPU computed the tangents because the GPU failed: {why}")),
    ] {
        let output = in_little_memory(device, folder.path());
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{told}");
        assert!(told.contains(&expected), "{told}");
        assert_eq!(folder.path().join(device).join("last.gltf").exists(), device == "auto");
        assert!(folder.path().join(device).join("39.gltf").exists());
    }
}

//! Files whose parts share their content, and jobs that share the memory of the process: what one needs alone
//! is enough for many.

#![cfg(target_os = "linux")]

mod common;

use std::fs;

use common::limited::ends_in_time;
use common::{darboux_in_with_addresses, darboux_with_addresses, glb, names_in, text};
use darboux_io::image::PngImage;
use serde_json::{Value, json};

/// A PNG of one colour, which a map of a plane has.
fn flat(side: usize) -> Vec<u8> {
    let texels = vec![[128u8, 128, 255]; side * side];
    let image = PngImage::from_rgb("map", [side as u32; 2], &texels).expect("an image");
    image.to_bytes().expect("a file")
}

/// A square in a buffer, with normals of a length, and what describes it: accessors 0 to 3 and a view 4 of
/// `data`.
fn square(length: f32, data: &[u8], members: Value) -> Vec<u8> {
    let corners = [[0.0f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let of =
        |vector: &dyn Fn([f32; 2]) -> Vec<f32>| corners.into_iter().flat_map(vector).collect::<Vec<f32>>();
    let mut binary: Vec<u8> = Vec::new();
    let mut views = Vec::new();
    let mut add = |bytes: &[u8]| {
        views.push(json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len() }));
        binary.extend(bytes);
        binary.resize(binary.len().next_multiple_of(4), 0);
    };
    for floats in
        [of(&|[x, y]| vec![x, y, 0.0]), of(&|_| vec![0.0, 0.0, length]), of(&|[x, y]| vec![x, 1.0 - y])]
    {
        add(&floats.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>());
    }
    add(&[0u32, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()).collect::<Vec<u8>>());
    add(data);
    let accessor = |view: usize, count: usize, kind: &str| {
        let component = if kind == "SCALAR" { 5125 } else { 5126 };
        json!({ "bufferView": view, "componentType": component, "count": count, "type": kind })
    };
    let mut json = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": binary.len() }],
        "bufferViews": views,
        "accessors": [accessor(0, 4, "VEC3"), accessor(1, 4, "VEC3"), accessor(2, 4, "VEC2"), accessor(3, 6, "SCALAR")],
    });
    for (name, value) in members.as_object().expect("members") {
        match json.get_mut(name).and_then(Value::as_array_mut) {
            Some(array) => array.extend(value.as_array().expect("an array").iter().cloned()),
            None => json[name] = value.clone(),
        }
    }
    glb(&json, &binary)
}

/// Primitives with a material each, and images over the same bytes, which `texture` of a material uses.
fn materials(count: usize, images: usize, map: &[u8], material: impl Fn(Value) -> Value) -> Vec<u8> {
    let attributes = json!({ "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 });
    let all = |count: usize, value: &dyn Fn(usize) -> Value| (0..count).map(value).collect::<Vec<Value>>();
    square(
        1.0,
        map,
        json!({
            "images": all(images, &|_| json!({ "bufferView": 4, "mimeType": "image/png" })),
            "textures": all(images, &|index| json!({ "source": index })),
            "materials": all(count, &|index| material(json!({ "index": index % images }))),
            "meshes": [{ "primitives": all(count, &|index| {
                json!({ "attributes": attributes, "indices": 3, "material": index })
            }) }],
            "nodes": [{ "mesh": 0 }],
        }),
    )
}

#[test]
fn an_image_is_decoded_once_for_all_materials() {
    let map = flat(2000);
    let normal = |texture: Value| json!({ "normalTexture": texture });
    let color = |texture: Value| json!({ "pbrMetallicRoughness": { "baseColorTexture": texture } });
    for images in [1, 50] {
        let line = "bake IN --high IN -o out.png --size 16";
        ends_in_time("m.glb", &materials(50, images, &map, normal), &[line]);
        let line = "bake IN --high IN -o out.png --size 16 --map base-color";
        ends_in_time("m.glb", &materials(50, images, &map, color), &[line]);
    }
    // Many materials, each of which is looked up.
    let line = "bake IN --high IN -o out.png --size 16";
    ends_in_time("m.glb", &materials(4000, 4000, &flat(4), normal), &[line]);
}

/// Images that are not the same share a limit.
#[test]
fn different_images_are_decoded_within_one_limit() {
    let map = flat(4000);
    let attributes = json!({ "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 });
    let all = |value: &dyn Fn(usize) -> Value| (0..20).map(value).collect::<Vec<Value>>();
    let mut data = map.clone();
    data.extend([0; 20]);
    let first = 48 + 48 + 32 + 24;
    // What follows a PNG belongs to no image.
    let view = |i: usize| json!({ "buffer": 0, "byteOffset": first, "byteLength": map.len() + i });
    let file = square(
        1.0,
        &data,
        json!({
            "bufferViews": all(&view),
            "images": all(&|i| json!({ "bufferView": 5 + i, "mimeType": "image/png" })),
            "textures": all(&|i| json!({ "source": i })),
            "materials": all(&|i| json!({ "normalTexture": { "index": i } })),
            "meshes": [{ "primitives": all(&|i| {
                json!({ "attributes": attributes, "indices": 3, "material": i })
            }) }],
            "nodes": [{ "mesh": 0 }],
        }),
    );
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("m.glb");
    fs::write(&path, &file).expect("a file");
    let (model, map) = (text(&path), folder.path().join("out.png"));
    let arguments = ["bake", model, "--high", model, "-o", text(&map), "--size", "16"];
    let run = darboux_with_addresses((512 << 20) + 10 * file.len(), &arguments).exits(0);
    let left_out =
        run.stderr.matches("and those of the images before need more than the memory limit").count();
    assert!((1..20).contains(&left_out), "{left_out}: {}", run.stderr);
    assert!(run.stderr.contains("raise the limit (--memory-limit)"), "{}", run.stderr);
}

/// Images over the same bytes, which materials of one primitive read in two ways by turns.
#[test]
fn the_same_map_is_judged_once_for_each_way_in_which_it_is_read() {
    let (map, count) = (flat(2000), 200);
    let all = |value: &dyn Fn(usize) -> Value| (0..count).map(value).collect::<Vec<Value>>();
    let mappings = all(&|i| json!({ "material": i, "variants": [i] }));
    let file = square(
        1.0,
        &map,
        json!({
            "extensionsUsed": ["KHR_materials_variants"],
            "extensions": { "KHR_materials_variants": { "variants": all(&|i| json!({ "name": i.to_string() })) } },
            "images": all(&|_| json!({ "bufferView": 4, "mimeType": "image/png" })),
            "samplers": [{ "wrapS": 10497 }, { "wrapS": 33071 }],
            "textures": all(&|i| json!({ "source": i, "sampler": i % 2 })),
            "materials": all(&|i| json!({ "normalTexture": { "index": i } })),
            "meshes": [{ "primitives": [{
                "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 },
                "indices": 3,
                "material": 0,
                "extensions": { "KHR_materials_variants": { "mappings": mappings } },
            }] }],
            "nodes": [{ "mesh": 0 }],
        }),
    );
    ends_in_time("m.glb", &file, &["check IN"]);
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("m.glb"), file).expect("a file");
    let report = common::darboux(&["check", text(&folder.path().join("m.glb")), "--json"]).exits(0).json();
    assert_eq!(report["totals"]["errors"], json!({}), "not all maps were judged");
    assert_eq!(report["totals"]["infos"]["map-flat"], count);
}

/// A normal map and a colour texture that fit alone and not together.
#[test]
fn normal_maps_and_other_textures_share_one_limit() {
    let [map, color] = [flat(1000), flat(999)];
    let data = [&map[..], &vec![0; map.len().next_multiple_of(4) - map.len()], &color].concat();
    let first = 48 + 48 + 32 + 24;
    let second = first + map.len().next_multiple_of(4);
    let views = json!([
        { "buffer": 0, "byteOffset": first, "byteLength": map.len() },
        { "buffer": 0, "byteOffset": second, "byteLength": color.len() },
    ]);
    let attributes = json!({ "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 });
    let members = json!({
        "bufferViews": views,
        "images": [{ "bufferView": 5, "mimeType": "image/png" }, { "bufferView": 6, "mimeType": "image/png" }],
        "textures": [{ "source": 0 }, { "source": 1 }],
        "materials": [{
            "normalTexture": { "index": 0 },
            "pbrMetallicRoughness": { "baseColorTexture": { "index": 1 } },
        }],
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": 3, "material": 0 }] }],
        "nodes": [{ "mesh": 0 }],
    });
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("m.glb"), square(1.0, &data, members)).expect("a file");
    let bake = |maps: &[&str]| {
        let model = folder.path().join("m.glb");
        let output = folder.path().join("out.png");
        let line = ["bake", text(&model), "--high", text(&model), "-o", text(&output), "--force"];
        let limits = ["--size", "16", "--memory-limit", "12"];
        common::darboux(&[&line[..], &limits, maps].concat()).exits(0).stderr
    };
    let left_out = "and those of the images before need more than the memory limit";
    assert!(!bake(&[]).contains(left_out));
    assert!(!bake(&["--no-high-maps", "--map", "base-color"]).contains(left_out));
    let both = bake(&["--map", "normal", "--map", "base-color"]);
    assert_eq!(both.matches(left_out).count(), 1, "{both}");
}

/// The output of an earlier run is compared with what would be written, without copies of accessors.
#[test]
fn an_earlier_repair_is_recognised_without_copies() {
    let elements = 100_000;
    let accessor = json!({ "bufferView": 4, "componentType": 5126, "count": elements, "type": "VEC3" });
    let attributes = json!({ "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 });
    let file = square(
        2.0,
        &vec![0; 12 * elements],
        json!({
            "accessors": vec![accessor; 3000],
            "images": [{ "uri": "missing.png" }],
            "textures": [{ "source": 0 }],
            "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
            "meshes": [{ "primitives": [{ "attributes": attributes, "indices": 3, "material": 0 }] }],
            "nodes": [{ "mesh": 0 }],
        }),
    );
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("m.glb");
    fs::write(&path, &file).expect("a file");
    let run = || {
        let arguments = ["check", text(&path), "--fix", "--fail-on", "never"];
        darboux_with_addresses((512 << 20) + 10 * file.len(), &arguments).exits(0)
    };
    run();
    assert_eq!(names_in(folder.path()), ["m.fixed.glb", "m.glb"]);
    let written =
        fs::metadata(folder.path().join("m.fixed.glb")).expect("a file").modified().expect("a time");
    let second = run();
    assert!(second.stderr.contains("up to date, not written"), "{}", second.stderr);
    let after = fs::metadata(folder.path().join("m.fixed.glb")).expect("a file").modified().expect("a time");
    assert_eq!(written, after);
}

/// A `.gltf` whose file for new data is another one is not what would be written.
#[test]
fn an_earlier_repair_is_compared_with_its_buffers() {
    let folder = tempfile::tempdir().expect("a folder");
    let attributes = json!({ "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 });
    let members = json!({
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": 3 }] }],
        "nodes": [{ "mesh": 0 }],
    });
    let [glb, model] = ["m.glb", "m.gltf"].map(|name| folder.path().join(name));
    fs::write(&glb, square(2.0, &[], members)).expect("a file");
    let convert = ["convert", text(&glb), "--from", "gltf", "--to", "gltf", "-o", text(&model)];
    common::darboux(&convert).exits(0);
    let fix = ["check", text(&model), "--fix", "--fail-on", "never"];
    common::darboux(&fix).exits(0);
    assert!(common::darboux(&fix).exits(0).stderr.contains("up to date, not written"));
    let fixed = folder.path().join("m.fixed.bin");
    let mut bytes = fs::read(&fixed).expect("a buffer");
    bytes[0] ^= 1;
    fs::write(&fixed, bytes).expect("a file");
    let refused = common::darboux(&fix).exits(1);
    assert!(refused.stderr.contains("other data would be written"), "{}", refused.stderr);
}

/// Small images that are large in memory.
#[test]
fn images_wait_for_the_memory_that_their_heads_declare() {
    let folder = tempfile::tempdir().expect("a folder");
    let (map, count) = (flat(2500), 5);
    for index in 0..count {
        fs::write(folder.path().join(format!("map{index}.png")), &map).expect("a file");
    }
    let names: Vec<String> = (0..count).map(|index| format!("map{index}.png")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let limited = |arguments: &[&[&str]]| {
        darboux_in_with_addresses(folder.path(), 300 << 20, &arguments.concat()).exits(0)
    };
    limited(&[&["check", "map0.png"]]);
    limited(&[&["check", "--jobs", "5"], &names]);
    limited(&[&["convert", "--from", "opengl", "--to", "directx", "--jobs", "5"], &names]);
    assert_eq!(names_in(folder.path()).len(), 2 * count);
}

/// A model that needs all memory, because its JSON is long, among many that are small. The journal tells the
/// order.
#[test]
fn a_large_file_gets_its_turn() {
    let folder = tempfile::tempdir().expect("a folder");
    let models = folder.path().join("models");
    fs::create_dir(&models).expect("a folder");
    let attributes = json!({ "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 });
    let model = |extras: &str| {
        let members = json!({
            "extras": extras,
            "meshes": [{ "primitives": [{ "attributes": attributes, "indices": 3 }] }],
            "nodes": [{ "mesh": 0 }],
        });
        square(1.0, &[], members)
    };
    let (small, large) = (model(""), model(&"x".repeat(5 << 20)));
    for index in 0..100 {
        let file = if index == 10 { &large } else { &small };
        fs::write(models.join(format!("{index:02}.glb")), file).expect("a file");
    }
    let arguments = ["tangents", "models", "--out-dir", "out", "--resume", "--jobs", "4"];
    darboux_in_with_addresses(folder.path(), 1 << 30, &arguments).exits(0);
    let journal = fs::read_to_string(folder.path().join("out/darboux-journal.jsonl")).expect("a journal");
    let mut begun = journal.lines().filter(|line| line.starts_with(r#"{"begun""#));
    let place = begun.position(|line| line.contains("10.glb")).expect("it was begun");
    // Others may have come while its thread did not run.
    assert!(place < 60, "{place} files were begun before it");
}

/// Models that fit one by one, with UV sets over the same bytes.
#[test]
fn models_wait_for_the_memory_of_their_uv_sets() {
    let (vertices, sets) = (19_998, 400);
    let attributes = (0..sets).map(|set| (format!("TEXCOORD_{set}"), json!(4 + set)));
    let attributes: serde_json::Map<String, Value> =
        attributes.chain([("POSITION".to_owned(), json!(4 + sets))]).collect();
    let accessor = |component: u32, kind: &str| {
        let normalized = component != 5126;
        json!({ "bufferView": 4, "componentType": component, "count": vertices, "type": kind, "normalized": normalized })
    };
    let mut accessors = vec![accessor(5123, "VEC2"); sets];
    accessors.push(accessor(5126, "VEC3"));
    let members = json!({
        "accessors": accessors,
        "meshes": [{ "primitives": [{ "attributes": attributes }] }],
    });
    fit_together("glb", &square(1.0, &vec![0; 12 * vertices], members), None);
}

/// Models that fit one by one, with buffers that are less than their files.
#[test]
fn models_wait_for_the_memory_of_the_files_of_their_buffers() {
    let json = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": 36, "uri": "data.bin" }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
    });
    fit_together("gltf", json.to_string().as_bytes(), Some(100 << 20));
}

/// Eight files of this content are checked at the same time in memory that is enough for one. `data`: the
/// size of a file data.bin beside them.
#[track_caller]
fn fit_together(ending: &str, content: &[u8], data: Option<u64>) {
    let folder = tempfile::tempdir().expect("a folder");
    let names: Vec<String> = (0..8).map(|index| format!("{index}.{ending}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    for name in &names {
        fs::write(folder.path().join(name), content).expect("a file");
    }
    if let Some(size) = data {
        let file = fs::File::create(folder.path().join("data.bin"));
        file.and_then(|file| file.set_len(size)).expect("a file");
    }
    for (jobs, names) in [("1", &names[..1]), ("8", &names[..])] {
        let arguments = [&["check", "--fail-on", "never", "--jobs", jobs], names].concat();
        darboux_in_with_addresses(folder.path(), 300 << 20, &arguments).exits(0);
    }
}

/// Bakes of a job that fit one by one.
#[test]
fn bakes_of_a_job_wait_for_the_memory_of_their_maps() {
    let folder = tempfile::tempdir().expect("a folder");
    let attributes = json!({ "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 });
    let members = json!({
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": 3 }] }],
        "nodes": [{ "mesh": 0 }],
    });
    fs::write(folder.path().join("m.glb"), square(1.0, &[], members)).expect("a file");
    let entry = |index: usize| {
        format!(
            "[[bake]]\nlow = \"m.glb\"\nhigh = \"m.glb\"\noutput = \"{index}.png\"\nsize = 1024\nmap = [\"normal\", \"position\"]\n"
        )
    };
    fs::write(folder.path().join("job.toml"), (0..6).map(entry).collect::<String>()).expect("a file");
    darboux_in_with_addresses(folder.path(), 250 << 20, &["bake", "job.toml", "--jobs", "6"]).exits(0);
    assert_eq!(names_in(folder.path()).iter().filter(|name| name.ends_with("normal.png")).count(), 6);
}

/// A bake whose tiles need more memory than its share, which is known before the first ray.
#[test]
fn a_bake_that_is_refused_at_the_start_is_baked_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    // Over each other in the UV layout.
    let indices: Vec<u8> = [0u32, 1, 2, 0, 2, 3].repeat(600).iter().flat_map(|i| i.to_le_bytes()).collect();
    let attributes = json!({ "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 });
    let members = json!({
        "accessors": [{ "bufferView": 4, "componentType": 5125, "count": indices.len() / 4, "type": "SCALAR" }],
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": 4 }] }],
        "nodes": [{ "mesh": 0 }],
    });
    fs::write(folder.path().join("m.glb"), square(1.0, &indices, members)).expect("a file");
    let entry = |index: usize| {
        format!("[[bake]]\nlow = \"m.glb\"\nhigh = \"m.glb\"\noutput = \"{index}.%UDIM%.png\"\nsize = 16\n")
    };
    fs::write(folder.path().join("job.toml"), (0..2).map(entry).collect::<String>()).expect("a file");
    common::darboux(&["bake", text(&folder.path().join("job.toml"))]).exits(0);
    assert_eq!(names_in(folder.path()), ["0.1001.png", "1.1001.png", "job.toml", "m.glb"]);
}

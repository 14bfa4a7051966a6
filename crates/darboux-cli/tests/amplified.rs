//! Small files whose names, white space, vertices, weights or matrices were copied for each of many elements
//! in an earlier version: each run must end within a limit of processor time that those copies pass by far,
//! in 512 MiB and ten times the file of addresses, and write little.

#![cfg(target_os = "linux")]

mod common;

use std::fs;

use common::builder::{Builder, SharedBytes};
use common::limited::{ends_beside, ends_in_time, is_refused};
use common::text;
use darboux_io::image::PngImage;
use serde_json::{Value, json};

/// 18,000 primitives of a mesh with a name of a megabyte.
#[test]
fn long_names_are_not_copied_for_each_primitive() {
    let mut builder = Builder::default();
    let mut primitive = builder.square();
    primitive["attributes"].as_object_mut().expect("attributes").remove("TANGENT");
    let mesh = json!({ "name": "n".repeat(1 << 20), "primitives": vec![primitive; 18_000] });
    let file = builder.glb(json!({ "meshes": [mesh] }));
    ends_in_time(
        "m.glb",
        &file,
        &[
            "check IN --json",
            "tangents IN --json -o out.gltf",
            "inspect IN --json",
            "convert IN --from gltf --to gltf -o out.obj",
        ],
    );
}

/// Primitives of one mesh, each with a material of its own, of which `same` follow each other.
fn with_materials(count: usize, same: usize, change: impl Fn(&mut Value)) -> Vec<u8> {
    let mut builder = Builder::default();
    let mut whole = builder.square();
    change(&mut whole);
    let primitive = |i: usize| {
        let mut primitive = whole.clone();
        primitive["material"] = json!(i / same);
        primitive
    };
    builder.glb(json!({
        "materials": vec![json!({ "name": "m", "normalTexture": { "index": 0 } }); count],
        "textures": [{ "source": 0 }],
        "images": [{ "uri": "missing.png" }],
        "meshes": [{ "primitives": (0..count).map(primitive).collect::<Vec<_>>() }],
    }))
}

#[test]
fn findings_and_repairs_take_time_in_proportion_to_their_number() {
    let lines = ["check IN", "check IN --fix -o out.glb"];
    ends_in_time("m.glb", &with_materials(3000, 1, |_| {}), &lines);
    ends_in_time("m.glb", &with_materials(3000, 2, |_| {}), &lines);
    let without_normals = |primitive: &mut Value| {
        let attributes = primitive["attributes"].as_object_mut().expect("attributes");
        attributes.remove("NORMAL");
        attributes.remove("TANGENT");
    };
    ends_in_time("m.glb", &with_materials(3000, 1, without_normals), &lines);
}

#[test]
fn equal_names_take_no_search() {
    let file = with_materials(12_000, 1, |_| {});
    ends_in_time("m.glb", &file, &["convert IN --from gltf --to gltf -o out.obj"]);
    let mut builder = Builder::default();
    let primitive = builder.square();
    let (png, count) =
        (PngImage::from_rgb("i", [1, 1], &[[0u8; 3]]).and_then(|image| image.to_bytes()), 1500);
    let view = builder.view(&png.expect("an image"));
    let all = |value: &dyn Fn(usize) -> Value| (0..count).map(value).collect::<Vec<Value>>();
    let with_material = |i: usize| {
        let mut primitive = primitive.clone();
        primitive["material"] = json!(i);
        primitive
    };
    let members = json!({
        "images": all(&|_| json!({ "bufferView": view, "mimeType": "image/png", "name": "i" })),
        "textures": all(&|i| json!({ "source": i })),
        "materials": all(&|i| json!({ "emissiveTexture": { "index": i } })),
        "meshes": [{ "primitives": all(&with_material) }],
    });
    let file = builder.glb(members);
    ends_in_time("m.glb", &file, &["convert IN --from gltf --to gltf -o out.obj"]);
}

#[test]
fn nodes_share_what_their_mesh_and_skin_have() {
    let lines = [
        "convert IN --from gltf --to gltf -o out.obj",
        "convert IN --from gltf --to gltf -o out.ply",
        "check IN",
        "inspect IN --quiet",
    ];
    let nodes = |count: usize, node: &dyn Fn(usize) -> Value| (0..count).map(node).collect::<Vec<Value>>();
    // Points in a mesh with some triangles, which is at many places.
    let mut builder = Builder::default();
    let whole = builder.square();
    let mut point = whole.clone();
    point["mode"] = json!(0);
    let mut primitives = vec![point; 4000];
    primitives.push(whole.clone());
    let members = json!({ "meshes": [{ "primitives": primitives }], "nodes": nodes(20_000, &|_| json!({ "mesh": 0 })) });
    ends_in_time("m.glb", &builder.glb(members), &lines);
    let mut builder = Builder::default();
    let whole = builder.square();
    let mesh = json!({ "primitives": [whole], "weights": vec![1; 100_000] });
    let members = json!({ "meshes": [mesh], "nodes": nodes(20_000, &|_| json!({ "mesh": 0 })) });
    ends_in_time("m.glb", &builder.glb(members), &lines);
    let mut builder = Builder::default();
    let whole = builder.square();
    let matrices = builder.floats(&vec![0.0; 16 * 8000], "MAT4", 8000);
    let count = 8000;
    let members = json!({
        "meshes": [{ "primitives": [whole] }],
        "skins": vec![json!({ "joints": [0], "inverseBindMatrices": matrices }); count],
        "nodes": nodes(count, &|i| json!({ "mesh": 0, "skin": i })),
    });
    ends_in_time("m.glb", &builder.glb(members), &lines);
}

/// Triangles of one primitive each, which share many vertices.
#[test]
fn shared_vertices_are_written_where_they_are_used() {
    let (count, vertices) = (3000, 30_000);
    let mut builder = Builder::default();
    let place = |i: usize| [(i % 200) as f32, (i / 200) as f32];
    let of = |vector: &dyn Fn([f32; 2]) -> Vec<f32>| {
        (0..vertices).flat_map(|i| vector(place(i))).collect::<Vec<f32>>()
    };
    let attributes = json!({
        "POSITION": builder.floats(&of(&|[x, y]| vec![x, y, 0.0]), "VEC3", vertices),
        "NORMAL": builder.floats(&of(&|_| vec![0.0, 0.0, 1.0]), "VEC3", vertices),
        "TEXCOORD_0": builder.floats(&of(&|[x, y]| vec![x / 200.0, y / 200.0]), "VEC2", vertices),
    });
    let primitives: Vec<Value> = (0..count as u32)
        .map(|i| json!({ "attributes": attributes, "indices": builder.indices(&[9 * i, 9 * i + 1, 9 * i + 200]) }))
        .collect();
    let file = builder.glb(json!({ "meshes": [{ "primitives": primitives }] }));
    ends_in_time(
        "m.glb",
        &file,
        &[
            "convert IN --from gltf --to gltf -o out.obj",
            "convert IN --from gltf --to gltf -o out.ply",
            "tangents IN -o out.glb",
        ],
    );
}

/// Where each of many primitives or nodes reads vertices that must be decoded, it reads those that it uses.
#[test]
fn shared_vertices_are_decoded_where_they_are_used() {
    let shared = SharedBytes {
        vertices: 300_000,
        primitives: 400,
        own_uvs: false,
        is_sparse: false,
        nodes: 1,
        own_meshes: false,
    };
    let lines = [
        "compare IN IN",
        "check IN",
        "inspect IN --quiet",
        "bake IN --high IN -o out.png --size 64",
        "convert IN --from gltf --to gltf -o out.obj",
    ];
    ends_in_time("m.glb", &shared.file(), &lines);
    ends_in_time("m.glb", &SharedBytes { is_sparse: true, ..shared }.file(), &lines);
    ends_in_time("m.glb", &SharedBytes { own_uvs: true, ..shared }.file(), &lines);
    let nodes = SharedBytes { primitives: 1, nodes: 400, ..shared };
    ends_in_time("m.glb", &nodes.file(), &lines);
    ends_in_time("m.glb", &shared.file(), &["tangents IN --overwrite -o out.glb"]);
    let file = SharedBytes { own_uvs: true, ..shared }.file();
    ends_in_time("m.glb", &file, &["normals IN --overwrite -o out.glb"]);
    let meshes = SharedBytes { vertices: 600_000, primitives: 8000, own_meshes: true, ..shared };
    ends_in_time("m.glb", &meshes.file(), &["normals IN --overwrite -o out.glb"]);
    // Each primitive gets tangents for all vertices of its own.
    is_refused("m.glb", &file, "tangents IN --overwrite -o out.glb", "share bytes so often");
}

/// A Draco stream of a million points and one face, which is that of many primitives.
#[test]
fn a_stream_of_many_primitives_is_decoded_once() {
    let (points, count) = (1_000_000usize, 8000);
    let mut builder = Builder::default();
    let position = builder.square()["attributes"]["POSITION"].clone();
    // Sequential connectivity with indices of 8 bits, and one attribute of 8 bits per point without
    // prediction.
    let million = [0xc0, 0x84, 0x3d];
    let mut stream = [b"DRACO".as_slice(), &[2, 2, 1, 0, 0, 0, 1], &million, &[1, 0, 1, 2]].concat();
    stream.extend([1, 1, 4, 2, 1, 0, 0, 0]);
    stream.resize(stream.len() + points, 0);
    let view = builder.view(&stream);
    let primitive = |_| {
        let indices = builder.accessor(json!({ "componentType": 5125, "count": 3, "type": "SCALAR" }));
        let draco = json!({ "bufferView": view, "attributes": {} });
        json!({ "attributes": { "POSITION": position }, "indices": indices,
            "extensions": { "KHR_draco_mesh_compression": draco } })
    };
    let primitives: Vec<Value> = (0..count).map(primitive).collect();
    let members = json!({
        "extensionsUsed": ["KHR_draco_mesh_compression"], "extensionsRequired": ["KHR_draco_mesh_compression"],
        "meshes": [{ "primitives": primitives }],
    });
    ends_in_time("m.glb", &builder.glb(members), &["check IN", "inspect IN --quiet"]);
}

/// Morph targets whose offsets are the same bytes, each one vertex later.
#[test]
fn offsets_of_morph_targets_are_read_where_they_are_used() {
    let (vertices, targets) = (300_000, 1500);
    let mut builder = Builder::default();
    let bytes: Vec<u8> = (0..4 * (vertices + targets)).map(|i| (i * 37 % 251) as u8).collect();
    let view = builder.view(&bytes);
    builder.views[view]["byteStride"] = json!(4);
    let positions =
        builder.floats(&(0..3 * vertices).map(|i| (i % 7) as f32).collect::<Vec<_>>(), "VEC3", vertices);
    let offsets = |first: usize| json!({ "bufferView": view, "byteOffset": 4 * first, "componentType": 5120, "count": vertices, "type": "VEC3" });
    let targets: Vec<Value> =
        (0..targets).map(|first| json!({ "POSITION": builder.accessor(offsets(first)) })).collect();
    let indices = builder.indices(&[0, 1, 2]);
    let file = builder.glb(json!({
        "extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": positions }, "indices": indices, "targets": targets }] }],
    }));
    ends_in_time("m.glb", &file, &["normals IN -o out.glb"]);
}

/// Materials for the variants of one primitive, each with an image of its own over the same bytes: judged
/// once by `check`, decoded once by `bake`, and written once beside an OBJ.
#[test]
fn images_over_the_same_bytes_are_read_once() {
    let (triangles, count) = (10_000, 1500);
    let mut builder = Builder::default();
    let mut primitive = builder.square();
    primitive["indices"] = json!(builder.indices(&[0, 1, 2].repeat(triangles)));
    primitive["material"] = json!(0);
    let mappings: Vec<Value> = (0..count).map(|i| json!({ "material": i, "variants": [0] })).collect();
    primitive["extensions"] = json!({ "KHR_materials_variants": { "mappings": mappings } });
    let texels: Vec<[u8; 3]> =
        (0..200 * 200).map(|i| [(100 + i % 57) as u8, (100 + i % 53) as u8, 240]).collect();
    let png = PngImage::from_rgb("i", [200, 200], &texels).and_then(|image| image.to_bytes());
    let view = builder.view(&png.expect("an image"));
    let all = |value: &dyn Fn(usize) -> Value| (0..count).map(value).collect::<Vec<Value>>();
    let members = json!({
        "extensions": { "KHR_materials_variants": { "variants": [{ "name": "v" }] } },
        "images": all(&|i| json!({ "bufferView": view, "mimeType": "image/png", "name": format!("{i}") })),
        "textures": all(&|i| json!({ "source": i })),
        "materials": all(&|i| json!({ "normalTexture": { "index": i } })),
        "meshes": [{ "primitives": [primitive.clone()] }],
    });
    let file = builder.glb(members);
    ends_in_time("m.glb", &file, &["check IN", "convert IN --from gltf --to gltf -o out.obj"]);

    let mut builder = Builder::default();
    let square = builder.square();
    let view = builder.view(
        &PngImage::from_rgb("i", [200, 200], &texels).and_then(|image| image.to_bytes()).expect("an image"),
    );
    let with_material = |i: usize| {
        let mut primitive = square.clone();
        primitive["material"] = json!(i);
        primitive
    };
    let members = json!({
        "images": all(&|_| json!({ "bufferView": view, "mimeType": "image/png" })),
        "textures": all(&|i| json!({ "source": i })),
        "materials": all(&|i| json!({ "normalTexture": { "index": i }, "pbrMetallicRoughness": { "baseColorTexture": { "index": i } } })),
        "meshes": [{ "primitives": all(&with_material) }],
    });
    let file = builder.glb(members);
    let lines = [
        "bake low.glb --high IN -o out.png --map normal --size 8",
        "bake low.glb --high IN -o out.png --map base-color --size 8",
    ];
    let mut builder = Builder::default();
    let square = builder.square();
    let low = builder.glb(json!({ "meshes": [{ "primitives": [square] }] }));
    ends_beside("m.glb", &file, &[("low.glb", &low)], &lines);
}

/// A scene of points has nothing that a PLY or an OBJ holds.
#[test]
fn a_scene_without_faces_is_not_written_as_one_of_faces() {
    let mut builder = Builder::default();
    let mut points = builder.square();
    points["mode"] = json!(0);
    let file = builder.glb(json!({ "meshes": [{ "primitives": [points] }] }));
    for output in ["out.obj", "out.ply"] {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("m.glb");
        fs::write(&path, &file).expect("a file");
        let output = folder.path().join(output);
        let run =
            common::darboux(&["convert", text(&path), "--from", "gltf", "--to", "gltf", "-o", text(&output)]);
        assert!(run.stderr.contains("has no faces"), "{}", run.stderr);
        run.exits(1);
        assert_eq!(common::names_in(folder.path()), ["m.glb"]);
    }
}

/// Two meshes in turn, whose names are written each time.
#[test]
fn names_of_objects_are_not_repeated_at_length() {
    // Characters of one byte and of three.
    for (letters, places) in [(["a", "b"], 6000), (["\u{20ac}", "\u{20a4}"], 1000)] {
        let mut builder = Builder::default();
        let square = builder.square();
        let meshes = letters.map(|letter| json!({ "name": letter.repeat(1000), "primitives": [square] }));
        let file = builder.glb(json!({
            "meshes": meshes,
            "nodes": (0..places).map(|i| json!({ "mesh": i % 2 })).collect::<Vec<_>>(),
        }));
        let folder = tempfile::tempdir().expect("a folder");
        let (path, output) = (folder.path().join("m.glb"), folder.path().join("out.obj"));
        fs::write(&path, file).expect("a file");
        common::darboux(&["convert", text(&path), "--from", "gltf", "--to", "gltf", "-o", text(&output)])
            .exits(0);
        let obj = fs::read_to_string(&output).expect("a text");
        assert!(obj.len() < 1 << 20, "{} bytes", obj.len());
        let mut names: Vec<&str> = obj.lines().filter(|line| line.starts_with("o ")).collect();
        assert_eq!(names.len(), places);
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), 2);
    }
}

/// Buffers over one file, each of another length.
#[test]
fn a_file_of_many_buffers_is_written_once() {
    let length = 1_000_000;
    for extra in [json!({}), json!({ "extras": 0 })] {
        let buffer = |i: usize| {
            // As one that an earlier run made, which the next one replaces.
            let mut buffer = json!({ "uri": "a.bin", "byteLength": length - i, "name": "darboux" });
            buffer.as_object_mut().expect("an object").extend(extra.as_object().expect("members").clone());
            buffer
        };
        let view = |i: usize| json!({ "buffer": i, "byteOffset": 4 * i, "byteLength": 36 });
        let accessor =
            |i: usize| json!({ "bufferView": i, "componentType": 5126, "count": 3, "type": "VEC3" });
        let of = |value: &dyn Fn(usize) -> Value| (0..60).map(value).collect::<Vec<Value>>();
        let json = json!({
            "asset": { "version": "2.0" },
            "buffers": of(&buffer),
            "bufferViews": of(&view),
            "accessors": of(&accessor),
            "meshes": [{ "primitives": of(&|i| json!({ "attributes": { "POSITION": i } })) }],
        });
        let model = json.to_string();
        let bytes: Vec<u8> = (0..length / 4).flat_map(|i| (i as f32).to_le_bytes()).collect();
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("m.gltf");
        fs::write(&path, &model).expect("a file");
        fs::write(folder.path().join("a.bin"), &bytes).expect("a file");
        for output in ["out.glb", "out.gltf"] {
            let folder = tempfile::tempdir_in(folder.path()).expect("a folder");
            let output = folder.path().join(output);
            common::darboux(&["normals", text(&path), "-o", text(&output)]).exits(0);
            let files = fs::read_dir(folder.path()).expect("a folder");
            let written: u64 =
                files.map(|file| file.and_then(|file| file.metadata()).expect("a file").len()).sum();
            assert!(written < 3 * length as u64, "{written} bytes");
            let options = darboux_io::LoadOptions::default();
            let document = darboux_io::gltf::Document::open(&output, &options).expect("a model");
            for i in 0..60 {
                let first = document.vectors::<3>(i).expect("positions")[0];
                assert_eq!(first, [i, i + 1, i + 2].map(|x| x as f32));
            }
            let buffers = document.json()["buffers"].as_array().expect("buffers");
            assert_eq!(buffers.len(), if extra["extras"] == 0 { 60 } else { 1 });
            let has_extras = extra.get("extras").is_some();
            assert!(buffers.iter().all(|buffer| buffer.get("extras").is_some() == has_extras));
        }
    }
}

#[test]
fn white_space_is_not_repeated() {
    use base64::Engine;

    let numbers = format!("{}{}0{}", "[".repeat(90), "0,".repeat(100_000), "]".repeat(90));
    for (indentation, extras) in [(100_000, "0"), (2, numbers.as_str())] {
        let mut builder = Builder::default();
        let primitive = builder.square();
        let data = base64::engine::general_purpose::STANDARD.encode(&builder.data);
        let json = json!({
            "asset": { "version": "2.0" },
            "buffers": [{ "byteLength": builder.data.len(), "uri": format!("data:application/octet-stream;base64,{data}") }],
            "bufferViews": builder.views,
            "accessors": builder.accessors,
            "meshes": [{ "primitives": vec![primitive; 2000] }],
        });
        let file = format!("{{\n{}\"extras\":{extras},{}", " ".repeat(indentation), &json.to_string()[1..]);
        ends_in_time(
            "m.gltf",
            file.as_bytes(),
            &["normals IN --overwrite -o out.gltf", "tangents IN --overwrite -o out.gltf"],
        );
    }
}

/// A triangle of the first of many vertices, whose normals are too long.
fn first_of(vertices: usize, builder: &mut Builder) -> (usize, Vec<u8>) {
    let mut positions = vec![0.0f32; 3 * vertices];
    positions[..9].copy_from_slice(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let normals = [0.0f32, 0.0, 2.0].map(f32::to_le_bytes).as_flattened().repeat(vertices);
    (builder.floats(&positions, "VEC3", vertices), normals)
}

/// Many UV sets of a primitive: of one accessor, and of one each, which need too much.
#[test]
fn uv_sets_of_one_accessor_are_read_once() {
    let (vertices, sets) = (60_000, 1000);
    for is_one in [true, false] {
        let mut builder = Builder::default();
        let (position, _) = first_of(vertices, &mut builder);
        let view = builder.view(&vec![7; 4 * vertices]);
        let uvs = json!({ "bufferView": view, "componentType": 5123, "normalized": true, "count": vertices, "type": "VEC2" });
        let mut attributes = json!({ "POSITION": position });
        let first = builder.accessor(uvs.clone());
        for set in 0..sets {
            let accessor = if is_one { first } else { builder.accessor(uvs.clone()) };
            attributes[format!("TEXCOORD_{set}")] = json!(accessor);
        }
        let file = builder.glb(json!({ "meshes": [{ "primitives": [{ "attributes": attributes }] }] }));
        if is_one {
            ends_in_time("m.glb", &file, &["check IN"]);
        } else {
            is_refused("m.glb", &file, "check IN", "have so many UVs that they need");
        }
    }
}

/// UVs of which every second one is not a number, in many sets: one finding for all of them.
#[test]
fn uvs_that_are_not_finite_are_found_once() {
    let (vertices, sets) = (60_000, 10_000);
    let mut builder = Builder::default();
    let (position, _) = first_of(vertices, &mut builder);
    let values: Vec<f32> = (0..vertices).flat_map(|vertex| [[f32::NAN, 0.0], [0.0; 2]][vertex % 2]).collect();
    let uvs = builder.floats(&values, "VEC2", vertices);
    let mut attributes = json!({ "POSITION": position });
    (0..sets).for_each(|set| attributes[format!("TEXCOORD_{set}")] = json!(uvs));
    let file = builder.glb(json!({ "meshes": [{ "primitives": [{ "attributes": attributes }] }] }));
    ends_in_time("m.glb", &file, &["check IN"]);
}

/// Many UV sets over the same bytes, and tangents that follow none of them.
#[test]
fn tangents_are_compared_with_few_uv_sets() {
    let (side, sets) = (50, 3000);
    let mut builder = Builder::default();
    let places =
        || (0..side * side).map(|vertex| [vertex % side, vertex / side].map(|x| x as f32 / side as f32));
    let of = |vector: fn([f32; 2]) -> Vec<f32>| places().flat_map(vector).collect::<Vec<f32>>();
    let uvs = builder.floats(&of(|[x, y]| vec![x, y]), "VEC2", side * side);
    let mut attributes = json!({
        "POSITION": builder.floats(&of(|[x, y]| vec![x, y, 0.05 * (7.0 * x).sin()]), "VEC3", side * side),
        "NORMAL": builder.floats(&of(|_| vec![0.0, 0.0, 1.0]), "VEC3", side * side),
        "TANGENT": builder.floats(
            &of(|[x, y]| vec![(91.0 * (x + 57.0 * y)).cos(), (91.0 * (x + 57.0 * y)).sin(), 0.0, 1.0]),
            "VEC4",
            side * side,
        ),
        "TEXCOORD_0": uvs,
    });
    for set in 1..sets {
        let same = builder.accessors[uvs].clone();
        attributes[format!("TEXCOORD_{set}")] = json!(builder.accessor(same));
    }
    let square = |at: usize| [at, at + 1, at + side + 1, at, at + side + 1, at + side];
    let corners = (0..side * (side - 1)).filter(|at| at % side < side - 1).flat_map(square);
    let indices = builder.indices(&corners.map(|corner| corner as u32).collect::<Vec<u32>>());
    let primitive = json!({ "attributes": attributes, "indices": indices, "material": 0 });
    let file = builder.glb(json!({
        "meshes": [{ "primitives": [primitive] }],
        "materials": [{ "normalTexture": { "index": 0 } }],
        "textures": [{}],
    }));
    ends_in_time("m.glb", &file, &["check IN"]);
}

/// Primitives of one accessor of tangents, each of which wants others of the last triangle.
#[test]
fn repairs_of_one_accessor_take_time_in_proportion_to_what_they_want() {
    let (primitives, triangles) = (1000, 20);
    let vertices = 3 * triangles;
    let mut builder = Builder::default();
    let corner = |vertex: usize| {
        let (x, y) = ((vertex / 3 % 5) as f32, (vertex / 15) as f32);
        [[x, y], [x + 0.8, y], [x, y + 0.8]][vertex % 3]
    };
    let of =
        |vector: fn([f32; 2]) -> Vec<f32>| (0..vertices).map(corner).flat_map(vector).collect::<Vec<f32>>();
    let shared = json!({
        "POSITION": builder.floats(&of(|[x, y]| vec![x, y, 0.0]), "VEC3", vertices),
        "NORMAL": builder.floats(&of(|_| vec![0.0, 0.0, 1.0]), "VEC3", vertices),
        "TANGENT": builder.floats(&of(|_| vec![f32::NAN, 0.0, 0.0, 1.0]), "VEC4", vertices),
    });
    let uvs = builder.floats(&of(|[x, y]| vec![x / 5.0, y / 5.0]), "VEC2", vertices);
    let uvs = builder.accessors[uvs]["bufferView"].clone();
    let last: Vec<u8> = (vertices - 3..vertices).flat_map(|vertex| (vertex as u32).to_le_bytes()).collect();
    let last = builder.view(&last);
    let primitive = |number: usize| {
        let (sin, cos) = (number as f32 * std::f32::consts::TAU / primitives as f32).sin_cos();
        let turned = [0.5, 0.5, 0.5 + 0.1 * cos, 0.5 + 0.1 * sin, 0.5 - 0.1 * sin, 0.5 + 0.1 * cos];
        let turned: Vec<u8> = turned.iter().flat_map(|x: &f32| x.to_le_bytes()).collect();
        let sparse = json!({
            "count": 3,
            "indices": { "bufferView": last, "componentType": 5125 },
            "values": { "bufferView": builder.view(&turned) },
        });
        let mut attributes = shared.clone();
        attributes["TEXCOORD_0"] = json!(builder.accessor(
            json!({ "bufferView": uvs, "componentType": 5126, "count": vertices, "type": "VEC2", "sparse": sparse })
        ));
        json!({ "attributes": attributes, "material": 0 })
    };
    let primitives: Vec<Value> = (0..primitives).map(primitive).collect();
    let file = builder.glb(json!({
        "meshes": [{ "primitives": primitives }],
        "materials": [{ "normalTexture": { "index": 0 } }],
        "textures": [{}],
    }));
    ends_in_time("m.glb", &file, &["check IN --fix -o out.glb"]);
}

/// Accessors over the same bytes, each of which a repair would write again.
#[test]
fn what_repairs_write_again_is_limited() {
    let (vertices, count) = (60_000, 1000);
    let mut builder = Builder::default();
    let (position, normals) = first_of(vertices, &mut builder);
    let view = builder.view(&normals);
    let indices = builder.indices(&[0, 1, 2]);
    let mut primitive = || {
        let normal = builder.accessor(
            json!({ "bufferView": view, "componentType": 5126, "count": vertices, "type": "VEC3" }),
        );
        json!({ "attributes": { "POSITION": position, "NORMAL": normal }, "indices": indices })
    };
    let primitives: Vec<Value> = (0..count).map(|_| primitive()).collect();
    let file = builder.glb(json!({ "meshes": [{ "primitives": primitives }] }));
    is_refused("m.glb", &file, "check IN --fix -o out.glb", "share bytes so often that the result needs");
}

/// What decoding takes is known from the head of an image.
#[test]
fn maps_are_decoded_within_the_memory_limit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("map.png");
    let side = 3000;
    let texels = vec![[128u8, 128, 255]; side * side];
    let image = PngImage::from_rgb("map", [side as u32; 2], &texels).expect("an image");
    fs::write(&path, image.to_bytes().expect("a file")).expect("a file");
    let run = common::darboux(&["check", text(&path), "--memory-limit", "64"]);
    let said = String::from_utf8_lossy(&run.stdout).into_owned() + &run.stderr;
    assert!(said.contains("3000 x 3000 texels, more than the limit"), "{said}");
    common::darboux(&["check", text(&path), "--memory-limit", "128"]).exits(0);
    let run = common::darboux(&[
        "check",
        text(&path),
        "--fix",
        "-o",
        text(&folder.path().join("out.png")),
        "--memory-limit",
        "64",
    ]);
    assert!(
        run.stderr.contains("memory limit") || run.stderr.contains("more than the limit"),
        "{}",
        run.stderr
    );
    assert_eq!(common::names_in(folder.path()), ["map.png"]);
}

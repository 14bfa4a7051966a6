//! Vertex data between conventions.

mod support;

use darboux::{Convention, Mesh, TangentOptions, generate_tangents};
use darboux_io::gltf::{ConversionSummary, Document, convert_vertices};
use serde_json::{Value, json};
use support::{BOTH, Builder, Vertices, butterfly, reread, run, square};

fn convert(document: &mut Document, from: Convention, to: Convention) -> ConversionSummary {
    convert_vertices(document, from, to, &mut |_| {}).expect("a conversion")
}

fn refusal(document: &mut Document, from: Convention, to: Convention) -> String {
    convert_vertices(document, from, to, &mut |_| {}).expect_err("a refusal").to_string()
}

/// The butterfly, bent, with a morph target and with tangents.
fn model(more: impl FnOnce(&mut Builder)) -> Document {
    let mut vertices = butterfly();
    vertices.positions[2] = [2.5, 0.25, -0.5];
    let mut builder = Builder::new();
    let (attributes, indices) = (vertices.attributes(&mut builder), builder.indices(&BOTH));
    let target = builder.vectors(&[[0.0f32, 0.5, 0.25]; 6]);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices, "targets": [{"POSITION": target}]})]);
    more(&mut builder);
    let mut document = builder.build();
    run(&mut document);
    // Written and read, so that there are no edits yet.
    Document::from_bytes("test.glb", document.to_glb().expect("a GLB"), None, &Default::default())
        .expect("a model")
}

/// Everything of the first primitive that has a meaning, as bits.
fn contents(document: &Document) -> (Vec<Vec<u32>>, Vec<u32>) {
    let primitive = &document.meshes()[0].primitives[0];
    let bits = |accessor: usize| -> Vec<u32> {
        let elements = document.read_elements(accessor).expect("elements");
        let words = elements.bytes.as_chunks::<4>().0;
        words.iter().map(|&bytes| u32::from_le_bytes(bytes)).collect()
    };
    let attributes = primitive.attributes.values().map(|&accessor| bits(accessor));
    let targets = primitive.targets.iter().flat_map(|target| target.values().map(|&accessor| bits(accessor)));
    (attributes.chain(targets).collect(), reread(document).indices(0, 0))
}

fn asset(document: &Document) -> Value {
    let glb = document.to_glb().expect("a GLB");
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
    serde_json::from_slice::<Value>(&glb[20..20 + length]).expect("JSON")["asset"].take()
}

#[test]
fn every_preset_comes_back_to_the_bit() {
    let original = model(|_| {});
    for (name, there) in Convention::PRESETS {
        let mut document = model(|_| {});
        convert(&mut document, Convention::GLTF, there);
        let differs = there != Convention::GLTF;
        assert_eq!(contents(&document) != contents(&original), differs, "{name}");
        assert_eq!(document.convention().is_some(), differs, "{name}");
        convert(&mut document, there, Convention::GLTF);
        assert_eq!(contents(&document), contents(&original), "{name}");
        assert_eq!(asset(&document), asset(&original), "{name}");
    }
}

/// The arrays of a converted file are a mesh of that convention: its tangents are those that the mesh has there.
#[test]
fn converted_numbers_mean_in_their_convention_what_they_meant() {
    for (name, there) in Convention::PRESETS {
        let mut document = model(|_| {});
        convert(&mut document, Convention::GLTF, there);
        let primitive = &document.meshes()[0].primitives[0];
        let positions = document.read_vectors::<3>(primitive.attributes["POSITION"]).expect("positions");
        let normals = document.read_vectors::<3>(primitive.attributes["NORMAL"]).expect("normals");
        let uvs = document.read_vectors::<2>(primitive.attributes["TEXCOORD_0"]).expect("UVs");
        let tangents = document.read_vectors::<4>(primitive.attributes["TANGENT"]).expect("tangents");
        let indices = document.read_indices(primitive.indices.expect("indices")).expect("indices");
        let mesh = Mesh::triangles(&positions, &normals, &uvs, &indices).expect("a mesh");
        let expected = generate_tangents(&mesh, &TangentOptions::default()).corners;
        let expected = expected.converted(there.generated(), there);
        for (&vertex, expected) in indices.iter().zip(expected.per_corner()) {
            let found = tangents[vertex as usize];
            let close = (0..4).all(|i| (found[i] - expected[i]).abs() < 1e-6);
            assert!(close, "{name}: {found:?} is not {expected:?}");
        }
    }
}

#[test]
fn offsets_of_morph_targets_are_vectors() {
    let mut document = model(|_| {});
    convert(&mut document, Convention::GLTF, Convention::BLENDER);
    let target = &document.meshes()[0].primitives[0].targets[0];
    let offsets = document.read_vectors::<3>(target["POSITION"]).expect("offsets");
    assert_eq!(offsets[0], [0.0, -0.25, 0.5]);
}

#[test]
fn strips_fans_and_lists_without_indices_are_reversed_and_points_are_not() {
    let Vertices { positions, .. } = square();
    let mut builder = Builder::new();
    let position = builder.vectors(&positions);
    let plain = |mode: u32| json!({"attributes": {"POSITION": position}, "mode": mode});
    builder.mesh(&[plain(5), plain(6), plain(0), plain(4)]);
    let mut document = builder.build();
    let summary = convert(&mut document, Convention::GLTF, Convention::GODOT);
    assert_eq!(summary.primitives, 3);
    assert!(summary.faces_reversed && !summary.axes_changed && !summary.uvs_flipped);
    let indices = |place| reread(&document).indices(0, place);
    assert_eq!(indices(0), [0, 2, 1, 1, 2, 3]);
    assert_eq!(indices(1), [1, 0, 2, 2, 0, 3]);
    assert_eq!(indices(3), [0, 2, 1, 3]);
    assert_eq!(document.meshes()[0].primitives[0].mode, 4);
    assert_eq!(document.meshes()[0].primitives[2].indices, None);
}

#[test]
fn a_file_remembers_its_convention() {
    let mut document = model(|_| {});
    convert(&mut document, Convention::GLTF, Convention::UNITY);
    assert_eq!(document.convention().as_deref(), Some("unity"));
    let sentence = refusal(&mut document, Convention::GLTF, Convention::BLENDER);
    assert_eq!(sentence, "test.glb: asset.extras.darboux_convention: says \"unity\"; convert it from that");
}

#[test]
fn what_moves_in_the_old_axes_is_refused() {
    let cases = [
        ("nodes", json!([{}, {"mesh": 0, "translation": [1, 0, 0]}]), "nodes[1]: moves or turns"),
        ("nodes", json!([{"mesh": 0, "rotation": [0, 1, 0, 0]}]), "nodes[0]"),
        ("skins", json!([{"joints": [0]}]), "skins[0]"),
        ("animations", json!([{"channels": [], "samplers": []}]), "animations[0]"),
    ];
    for (key, value, part) in cases {
        let mut document = model(|builder| builder.set(key, value));
        let sentence = refusal(&mut document, Convention::GLTF, Convention::BLENDER);
        assert!(sentence.contains(part), "{sentence}");
        assert!(!document.is_changed());
        convert(&mut document, Convention::GLTF, Convention::OPENGL);
    }
    let still = json!([{"mesh": 0, "scale": [1, 1, 1.0], "translation": [0, 0, 0]}]);
    convert(&mut model(|builder| builder.set("nodes", still)), Convention::GLTF, Convention::BLENDER);
}

#[test]
fn what_else_must_change_is_said() {
    let build = || {
        model(|builder| {
            builder.material(json!({"normalTexture": {"index": 0}}));
            builder.set("extensionsUsed", json!(["KHR_texture_transform"]));
        })
    };
    let warnings = |to| convert(&mut build(), Convention::GLTF, to).warnings;
    assert!(warnings(Convention::GODOT).is_empty());
    assert_eq!(warnings(Convention::OPENGL).len(), 1);
    assert!(warnings(Convention::UNREAL)[0].contains("materials[0]"));
    assert_eq!(warnings(Convention::MAX).len(), 2);
}

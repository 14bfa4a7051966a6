//! Conversion of vertex data between conventions.

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
    // WrittenTangents and read, so that there are no edits yet.
    Document::from_bytes("test.glb", document.to_glb().expect("a GLB"), None, &Default::default())
        .expect("a model")
}

/// Everything of the first primitive that has a meaning, as bits.
fn contents(document: &Document) -> (Vec<Vec<u32>>, Vec<u32>) {
    let primitive = &document.meshes()[0].primitives[0];
    let bits = |accessor: usize| -> Vec<u32> {
        let elements = document.elements(accessor).expect("elements");
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
        assert_eq!(document.convention().expect("a convention"), there, "{name}");
        convert(&mut document, there, Convention::GLTF);
        assert_eq!(contents(&document), contents(&original), "{name}");
        assert_eq!(asset(&document), asset(&original), "{name}");
    }
}

/// The arrays of a converted file are a mesh of that convention: its tangents are those that the mesh has
/// there.
#[test]
fn converted_data_describes_the_same_surface() {
    for (name, there) in Convention::PRESETS {
        let mut document = model(|_| {});
        convert(&mut document, Convention::GLTF, there);
        let primitive = &document.meshes()[0].primitives[0];
        let positions =
            document.vectors::<3>(primitive.attributes["POSITION"]).expect("positions").into_owned();
        let normals = document.vectors::<3>(primitive.attributes["NORMAL"]).expect("normals").into_owned();
        let uvs = document.vectors::<2>(primitive.attributes["TEXCOORD_0"]).expect("UVs").into_owned();
        let tangents = document.vectors::<4>(primitive.attributes["TANGENT"]).expect("tangents").into_owned();
        let indices = document.indices(primitive.indices.expect("indices")).expect("indices").into_u32();
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
    let offsets = document.vectors::<3>(target["POSITION"]).expect("offsets").into_owned();
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
    assert_eq!(document.convention().expect("a convention"), Convention::UNITY);
    let sentence = refusal(&mut document, Convention::GLTF, Convention::BLENDER);
    assert_eq!(
        sentence,
        "test.glb: asset.extras.darboux_convention: is \"unity\"; convert from that convention"
    );
}

#[test]
fn marks_of_conventions_are_written_and_checked() {
    let custom: Convention = "gltf,green=down,w=t-cross-n,fronts=cw".parse().expect("a convention");
    let mut document = model(|_| {});
    let before = contents(&document);
    convert(&mut document, Convention::GLTF, custom);
    assert_eq!(asset(&document)["extras"]["darboux_convention"], "gltf,fronts=cw,green=down,w=t-cross-n");
    assert_eq!(document.convention().expect("a convention"), custom);
    convert(&mut document, custom, Convention::GLTF);
    assert_eq!((contents(&document), asset(&document)["extras"].is_null()), (before, true));
    let noted = |note: Value| {
        model(|builder| {
            builder.set("asset", json!({"version": "2.0", "extras": {"darboux_convention": note}}))
        })
    };
    for (note, part) in
        [(json!("quake"), "\"quake\" is not a convention; begin with"), (json!(7), "7 is not a string; ")]
    {
        let mut document = noted(note);
        let sentence = refusal(&mut document, Convention::UNITY, Convention::GLTF);
        assert!(
            sentence.contains(part) && sentence.contains("asset.extras.darboux_convention: "),
            "{sentence}"
        );
        assert_eq!(document.convention().expect_err("no convention").to_string(), sentence);
    }
    let mut needless = noted(json!("gltf"));
    assert_eq!(needless.convention().expect("a convention"), Convention::GLTF);
    convert(&mut needless, Convention::GLTF, Convention::GLTF);
    assert!(asset(&needless)["extras"].is_null());
    let mut kept = noted(json!("unity"));
    convert(&mut kept, Convention::UNITY, Convention::UNITY);
    assert!(!kept.is_changed());
}

#[test]
fn summaries_list_actual_changes_only() {
    let told = |document: &mut Document, from: &str, to: &str| {
        let [from, to] = [from, to].map(|name| name.parse().expect("a convention"));
        let summary = convert(document, from, to);
        (
            summary.primitives,
            summary.axes_changed,
            summary.uvs_flipped,
            summary.faces_reversed,
            summary.tangents_changed,
        )
    };
    assert_eq!(told(&mut model(|_| {}), "gltf", "unreal"), (1, true, false, false, false));
    assert_eq!(told(&mut model(|_| {}), "gltf", "unity"), (1, true, true, true, true));
    assert_eq!(told(&mut model(|_| {}), "blender", "3dsmax"), (1, false, false, false, true));
    let points = |builder: &mut Builder| {
        let position = builder.vectors(&[[0.0f32; 3]; 3]);
        builder.mesh(&[json!({"attributes": {"POSITION": position}, "mode": 0})]);
    };
    let mut builder = Builder::new();
    points(&mut builder);
    let mut document = builder.build();
    assert_eq!(told(&mut document, "opengl", "gltf"), (0, false, false, false, false));
    assert!(!document.is_changed());
    assert_eq!(told(&mut document, "gltf", "blender"), (1, true, false, false, false));
}

/// A file of cameras, bones or animations alone stands in axes, too.
#[test]
fn files_without_meshes_are_turned() {
    let mut builder = Builder::new();
    builder.set("nodes", json!([{"translation": [1, 2, 3]}, {"name": "still"}]));
    let mut document = builder.build();
    let summary = convert(&mut document, Convention::GLTF, Convention::UNITY);
    assert!(summary.axes_changed && summary.primitives == 0, "{summary:?}");
    assert_eq!(document.convention().expect("a convention"), Convention::UNITY);
    let glb = document.to_glb().expect("a GLB");
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
    let json: Value = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
    assert_eq!(json["nodes"], json!([{"translation": [-1.0, 2.0, 3.0]}, {"name": "still"}]));
}

/// Adds a scene around the model: a parent with a matrix, children with each kind of transform, a skin, an
/// animation.
fn add_scene(builder: &mut Builder) {
    let matrix = [0.0f32, 2.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.5, 0.0, 4.0, 5.0, 6.0, 1.0];
    let skewed = [1.0f32, 0.5, 0.0, 0.0, 0.0, 1.0, 0.25, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 2.0, 3.0, 1.0];
    let matrices = [matrix, skewed].concat();
    let bytes: Vec<u8> = matrices.iter().flat_map(|x| x.to_le_bytes()).collect();
    let bind = builder.accessor(&bytes, 2, 5126, "MAT4", json!({}));
    let times = builder.vectors(&[[0.0f32], [1.0]]);
    let moves = builder.vectors(&[[1.0f32, 2.0, 3.0], [4.0, 5.0, 7.0]]);
    let turns = builder.vectors(&[[0.6f32, 0.0, 0.0, 0.8], [0.0, 0.8, 0.0, 0.6]]);
    let scales = builder.vectors(&[[1.0f32, 2.0, 3.0], [3.0, 2.0, 1.0]]);
    let sampler = |output: usize| json!({"input": times, "output": output});
    let channel =
        |sampler: usize, path: &str| json!({"sampler": sampler, "target": {"node": 1, "path": path}});
    builder.set(
        "nodes",
        json!([
            {"matrix": matrix, "children": [1, 2]},
            {"translation": [1, 2, 3.5], "rotation": [0.48, 0.6, 0.0, 0.64], "scale": [1, 2, 3], "children": [3]},
            {"mesh": 0, "skin": 0},
            {"rotation": [0, 0, 0.6, 0.8]},
        ]),
    );
    builder.set("skins", json!([{"joints": [1, 3], "inverseBindMatrices": bind}]));
    builder.set(
        "animations",
        json!([{
            "samplers": [sampler(moves), sampler(turns), sampler(scales)],
            "channels": [channel(0, "translation"), channel(1, "rotation"), channel(2, "scale")],
        }]),
    );
}

type Matrix = [[f32; 4]; 4];

fn apply(matrix: Matrix, [x, y, z]: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| matrix[0][i] * x + matrix[1][i] * y + matrix[2][i] * z + matrix[3][i])
}

/// Where some points of every node's space, and of every joint's, are at rest and at each keyframe, as the
/// `gltf` crate reads it.
fn places(document: &Document, points: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let read = gltf::Gltf::from_slice(&document.to_glb().expect("a GLB")).expect("a valid GLB");
    let blob = read.blob.clone().expect("a binary chunk");
    let mut parents = vec![None; read.nodes().len()];
    read.nodes()
        .for_each(|node| node.children().for_each(|child| parents[child.index()] = Some(node.index())));
    let locals: Vec<Matrix> = read.nodes().map(|node| node.transform().matrix()).collect();
    let to_world = |node: usize, locals: &[Matrix], point: [f32; 3]| {
        std::iter::successors(Some(node), |node| parents[*node])
            .fold(point, |point, node| apply(locals[node], point))
    };
    let mut out = Vec::new();
    let mut note = |locals: &[Matrix]| {
        for &point in points {
            out.extend((0..locals.len()).map(|node| to_world(node, locals, point)));
            for skin in read.skins() {
                let bind = skin.reader(|_| Some(&blob)).read_inverse_bind_matrices().expect("matrices");
                let joints = skin.joints().zip(bind);
                out.extend(joints.map(|(joint, bind)| to_world(joint.index(), locals, apply(bind, point))));
            }
        }
    };
    note(&locals);
    let outputs =
        |channel: gltf::animation::Channel<'_>| channel.reader(|_| Some(&blob)).read_outputs().expect("keys");
    let keys: Vec<_> = read
        .animations()
        .flat_map(|animation| animation.channels().map(outputs).collect::<Vec<_>>())
        .collect();
    let [moves, turns, scales] = <[_; 3]>::try_from(keys).ok().expect("three channels");
    use gltf::animation::util::ReadOutputs::{Rotations, Scales, Translations};
    let (Translations(moves), Rotations(turns), Scales(scales)) = (moves, turns, scales) else {
        panic!("their order")
    };
    for ((translation, rotation), scale) in moves.zip(turns.into_f32()).zip(scales) {
        let mut locals = locals.clone();
        locals[1] = gltf::scene::Transform::Decomposed { translation, rotation, scale }.matrix();
        note(&locals);
    }
    out
}

#[test]
fn scene_transforms_place_meshes_as_before() {
    let points = [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0], [-0.5, 0.25, 4.0]];
    for (name, there) in Convention::PRESETS {
        let conversion = Convention::GLTF.to(there);
        let mut document = model(add_scene);
        let before = places(&document, &points);
        convert(&mut document, Convention::GLTF, there);
        let after = places(&document, &points.map(|point| conversion.vector(point)));
        assert_eq!(before.len(), after.len());
        for (before, after) in before.iter().zip(&after) {
            let expected = conversion.vector(*before);
            let close = (0..3).all(|i| (expected[i] - after[i]).abs() <= 1e-4 * before[i].abs().max(10.0));
            assert!(close, "{name}: {after:?} is not {expected:?}");
        }
        convert(&mut document, there, Convention::GLTF);
        assert_eq!(places(&document, &points), before, "{name}");
    }
}

#[test]
fn instances_are_turned() {
    let mut document = model(|builder| {
        let moves = builder.vectors(&[[1.0f32, 2.0, 3.0]]);
        let extensions =
            json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": moves, "_ID": moves}}});
        builder.set("nodes", json!([{"mesh": 0, "extensions": extensions}]));
    });
    let summary = convert(&mut document, Convention::GLTF, Convention::UNITY);
    assert!(summary.warnings.is_empty(), "{:?}", summary.warnings);
    let glb = document.to_glb().expect("a GLB");
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
    let json: Value = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
    let attributes = &json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    let read = |name: &str| {
        let again =
            Document::from_bytes("test.glb", glb.clone(), None, &Default::default()).expect("a model");
        again
            .vectors::<3>(attributes[name].as_u64().expect("a number") as usize)
            .expect("vectors")
            .into_owned()
    };
    assert_eq!(read("TRANSLATION"), [[-1.0, 2.0, 3.0]]);
    assert_eq!(read("_ID"), [[1.0, 2.0, 3.0]]);
}

#[test]
fn transforms_that_cannot_be_converted_are_errors() {
    let channel = |path: &str| json!({"sampler": 0, "target": {"node": 0, "path": path}});
    let animation =
        |channels: &[Value]| json!([{"samplers": [{"input": 0, "output": 0}], "channels": channels}]);
    let cases = [
        ("animations", animation(&[channel("pointer")]), "animations[0].channels[0]: animates a property"),
        (
            "animations",
            animation(&[channel("scale"), channel("translation")]),
            "animations[0].channels[1]: shares its sampler",
        ),
        (
            "nodes",
            json!([{"mesh": 0, "translation": [1, 0]}]),
            "nodes[0].translation: has 2 numbers instead of 3",
        ),
        (
            "nodes",
            json!([{"mesh": 0, "matrix": "none"}]),
            "nodes[0].matrix: is \"none\"; it must be an array",
        ),
    ];
    for (key, value, part) in cases {
        let mut document = model(|builder| {
            builder.set("nodes", json!([{}]));
            builder.set(key, value);
        });
        let sentence = refusal(&mut document, Convention::GLTF, Convention::BLENDER);
        assert!(sentence.contains(part), "{sentence}");
    }
}

#[test]
fn unconverted_data_is_a_warning() {
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
    let mut seen = model(|builder| {
        builder.set("cameras", json!([{}]));
        builder.set("nodes", json!([{"camera": 0, "extensions": {"VENDOR_path": {}}}]));
    });
    let said = convert(&mut seen, Convention::GLTF, Convention::UNITY).warnings;
    assert!(said[0].contains("cameras") && said[1].contains("VENDOR_path"), "{said:?}");
    assert_eq!(warnings(Convention::MAX).len(), 2, "{:?}", warnings(Convention::MAX));
}

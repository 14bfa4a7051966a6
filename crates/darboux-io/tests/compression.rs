//! Compressed documents: decoded data equals the original, extensions are removed, and damaged streams are
//! errors.

use std::collections::BTreeSet;
use std::path::PathBuf;

use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents};
use darboux_io::{Error, LoadOptions, SaveOptions};
use serde_json::{Value, json};

fn asset(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets/made").join(name)
}

fn open(name: &str) -> Document {
    Document::open(&asset(name), &LoadOptions::default()).unwrap()
}

fn decompressed(name: &str) -> Document {
    let mut document = open(name);
    assert!(!document.is_changed());
    document.discard_compression();
    assert!(document.is_changed());
    document
}

/// Positions and UVs of the corners of a primitive.
fn corners(document: &Document, primitive: usize) -> Vec<([f32; 3], [f32; 2])> {
    let primitive = &document.meshes()[0].primitives[primitive];
    let positions = document.vectors(primitive.attributes["POSITION"]).unwrap().into_owned();
    let uvs = document.vectors(primitive.attributes["TEXCOORD_0"]).unwrap().into_owned();
    let indices = document.indices(primitive.indices.unwrap()).unwrap().into_u32();
    indices.iter().map(|&i| (positions[i as usize], uvs[i as usize])).collect()
}

fn json_of(glb: &[u8]) -> Value {
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&glb[20..20 + length]).unwrap()
}

#[test]
fn without_edits_a_compressed_file_is_kept_to_the_byte() {
    for name in ["draco.glb", "meshopt.glb"] {
        assert_eq!(open(name).to_glb().unwrap(), std::fs::read(asset(name)).unwrap());
    }
}

#[test]
fn draco_primitives_become_plain() {
    let document = decompressed("draco.glb");
    let original = open("shared-vertices-two-uv-sets.gltf");
    for primitive in 0..document.meshes()[0].primitives.len() {
        let (found, expected) = (corners(&document, primitive), corners(&original, primitive));
        assert_eq!(found.len(), expected.len());
        // Positions have 14 bits over an extent of 2, UVs 12 over 1; triangles come in another order.
        for (position, uv) in found {
            let near = |&(p, u): &([f32; 3], [f32; 2])| {
                let moved = (0..3).map(|i| (p[i] - position[i]).abs()).fold(0.0, f32::max);
                moved < 2e-4 && (0..2).all(|i| (u[i] - uv[i]).abs() < 3e-4)
            };
            assert!(expected.iter().any(near), "{position:?} {uv:?}");
        }
    }
    let written = document.to_glb().unwrap();
    let json = json_of(&written);
    assert!(!json.to_string().contains("draco"), "{json}");
    let min: Vec<f64> = serde_json::from_value(json["accessors"][1]["min"].clone()).unwrap();
    let positions = document.vectors::<3>(1).unwrap().into_owned();
    let least = |i: usize| positions.iter().map(|p| p[i]).fold(f32::INFINITY, f32::min);
    assert_eq!(min, [0, 1, 2].map(|i| f64::from(least(i))), "bounds are those of the decoded values");
}

#[test]
fn meshopt_views_become_plain() {
    let document = decompressed("meshopt.glb");
    let original = open("skinned-morphed-mirrored.gltf");
    let bits = |document: &Document| -> BTreeSet<Vec<u32>> {
        let floats = corners(document, 0).into_iter().map(|(p, u)| [p.as_slice(), &u].concat());
        floats.map(|corner| corner.iter().map(|x| x.to_bits()).collect()).collect()
    };
    assert_eq!(bits(&document), bits(&original));
    let written = document.to_glb().unwrap();
    let json = json_of(&written);
    assert!(!json.to_string().contains("meshopt"), "{json}");
    assert_eq!(json["buffers"].as_array().unwrap().len(), 1);
    let plain = Document::from_bytes("plain", written, None, &LoadOptions::default()).unwrap();
    assert_eq!(bits(&plain), bits(&original));
}

/// A document of compressed views, `(stream, count, stride, mode, filter)` each, with a `VEC4`, normalised
/// where not float, or scalar accessor on each.
fn compressed(name: &str, views: &[(Vec<u8>, usize, usize, &str, &str)]) -> Value {
    let (mut bytes, mut decoded) = (Vec::new(), 0);
    let (mut json_views, mut accessors) = (Vec::new(), Vec::new());
    for (i, (stream, count, stride, mode, filter)) in views.iter().enumerate() {
        json_views.push(json!({"buffer": 1, "byteOffset": decoded, "byteLength": count * stride, "extensions": {name: {
            "buffer": 0, "byteOffset": bytes.len(), "byteLength": stream.len(), "count": count, "byteStride": stride,
            "mode": mode, "filter": filter,
        }}}));
        let (kind, component) = match (*mode, *stride) {
            ("ATTRIBUTES", 16) => ("VEC4", 5126),
            ("ATTRIBUTES", 8) => ("VEC4", if *filter == "COLOR" { 5123 } else { 5122 }),
            ("ATTRIBUTES", _) => ("VEC4", if *filter == "COLOR" { 5121 } else { 5120 }),
            (_, 2) => ("SCALAR", 5123),
            _ => ("SCALAR", 5125),
        };
        let normalized = component < 5124 && kind == "VEC4";
        accessors.push(json!({"bufferView": i, "componentType": component, "count": count, "type": kind,
            "normalized": normalized}));
        decoded += count * stride;
        bytes.extend(stream);
    }
    use base64::Engine;
    let uri = format!("data:;base64,{}", base64::engine::general_purpose::STANDARD.encode(&bytes));
    json!({
        "asset": {"version": "2.0"}, "accessors": accessors, "bufferViews": json_views,
        "buffers": [
            {"byteLength": bytes.len(), "uri": uri},
            {"byteLength": decoded, "extensions": {name: {"fallback": true}}},
        ],
        "extensionsUsed": [name, "OTHER"], "extensionsRequired": [name],
    })
}

fn decode(json: &Value) -> Result<Document, Error> {
    let mut document =
        Document::from_bytes("x.gltf", json.to_string().into(), None, &LoadOptions::default())?;
    document.discard_compression();
    Ok(document)
}

const VECTORS: [[f32; 4]; 3] = [[0.6, 0.0, 0.8, 0.0], [0.0, -1.0, 0.0, 1.0], [0.48, 0.64, -0.6, 1.0]];
const INDICES: [u32; 6] = [0, 1, 2, 2, 1, 70000];

fn every_filter() -> Vec<(Vec<u8>, usize, usize, &'static str, &'static str)> {
    let v1 = |bytes: Vec<u8>, stride| (bytes, 3, stride, "ATTRIBUTES");
    let exponential = meshopt::encode_filter_exp(&VECTORS, 15, meshopt::EncodeExpMode::Separate);
    let positive = VECTORS.map(|v| v.map(f32::abs));
    let shorts = INDICES.map(|i| i.min(3));
    macro_rules! view {
        ($data:expr, $stride:literal, $filter:literal) => {{
            let (bytes, count, stride, mode) =
                v1(meshopt::encode_vertex_buffer_level(&$data, 2, Some(1)).unwrap(), $stride);
            (bytes, count, stride, mode, $filter)
        }};
    }
    vec![
        view!(VECTORS, 16, "NONE"),
        view!(exponential, 16, "EXPONENTIAL"),
        view!(meshopt::encode_filter_oct::<i8>(&VECTORS, 8), 4, "OCTAHEDRAL"),
        view!(meshopt::encode_filter_oct::<i16>(&VECTORS, 12), 8, "OCTAHEDRAL"),
        view!(meshopt::encode_filter_color::<u8>(&positive, 8), 4, "COLOR"),
        view!(meshopt::encode_filter_color::<u16>(&positive, 12), 8, "COLOR"),
        view!(meshopt::encode_filter_quat(&VECTORS.map(|[x, y, z, _]| [x, y, z, 0.0]), 16), 8, "QUATERNION"),
        (meshopt::encode_index_buffer(&shorts, 4).unwrap(), 6, 2, "TRIANGLES", "NONE"),
        (meshopt::encode_index_buffer(&INDICES, 70001).unwrap(), 6, 4, "TRIANGLES", "NONE"),
        (meshopt::encode_index_sequence(&shorts, 4).unwrap(), 6, 2, "INDICES", "NONE"),
        (meshopt::encode_index_sequence(&INDICES, 70001).unwrap(), 6, 4, "INDICES", "NONE"),
    ]
}

#[test]
fn every_mode_and_filter_decodes_under_both_names() {
    for name in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        let document = decode(&compressed(name, &every_filter())).unwrap();
        assert_eq!(document.vectors::<4>(0).unwrap()[..], VECTORS);
        for accessor in 1..=6 {
            for (found, vector) in document.vectors::<4>(accessor).unwrap().iter().zip(VECTORS) {
                let expected = match accessor {
                    4 | 5 => vector.map(f32::abs),
                    6 => [vector[0], vector[1], vector[2], 0.0],
                    _ => vector,
                };
                // Quaternions may come back negated.
                let sign = if accessor == 6 && found[1] * expected[1] < 0.0 { -1.0 } else { 1.0 };
                let close = found.iter().zip(expected).all(|(a, b)| (a * sign - b).abs() < 0.02);
                assert!(close, "{accessor}: {found:?} is not {expected:?}");
            }
        }
        for accessor in 7..=10 {
            let wide = accessor % 2 == 0;
            let expected = INDICES.map(|i| if wide { i } else { i.min(3) });
            assert_eq!(document.indices(accessor).unwrap().into_u32(), expected, "{accessor}");
        }
        let json = json_of(&document.to_glb().unwrap());
        assert!(!json.to_string().contains("meshopt"), "{json}");
        assert_eq!(json["extensionsUsed"], json!(["OTHER"]));
        assert_eq!(json.get("extensionsRequired"), None);
    }
}

#[test]
fn promises_that_a_stream_cannot_keep_are_refused() {
    let name = "EXT_meshopt_compression";
    let good = compressed(name, &every_filter());
    let refused = |pointer: &str, value: Value| {
        let mut json = good.clone();
        *json.pointer_mut(pointer).unwrap() = value;
        let error = decode(&json).map(|_| ()).unwrap_err().to_string();
        assert!(error.starts_with("x.gltf: bu"), "{error}");
    };
    let extension = |member: &str| format!("/bufferViews/0/extensions/{name}/{member}");
    refused(&extension("count"), json!(4));
    refused(&extension("count"), json!(u64::MAX));
    refused(&extension("byteStride"), json!(3));
    refused(&extension("byteLength"), json!(1));
    refused(&extension("byteLength"), json!(1_000_000));
    refused(&extension("buffer"), json!(9));
    refused(&extension("buffer"), json!(1));
    refused(&extension("mode"), json!("TRIANGLES"));
    refused(&extension("mode"), json!("ODD"));
    refused(&extension("filter"), json!("QUATERNION"));
    refused("/bufferViews/0/byteOffset", json!(1_000_000));
    refused("/bufferViews/0/buffer", json!(9));

    // A few bytes that claim to be gigabytes.
    let mut json = good.clone();
    json["bufferViews"][0]["byteLength"] = json!(1u64 << 40);
    *json.pointer_mut(&extension("count")).unwrap() = json!(1u64 << 36);
    json["buffers"][1]["byteLength"] = json!(1u64 << 41);
    let error = decode(&json).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("cannot hold"), "{error}");
}

#[test]
fn damaged_streams_never_panic() {
    for name in ["draco.glb", "meshopt.glb"] {
        let good = std::fs::read(asset(name)).unwrap();
        let start = 28 + u32::from_le_bytes(good[12..16].try_into().unwrap()) as usize;
        for at in start..good.len() {
            let mut bytes = good.clone();
            bytes[at] ^= [0x01, 0x80, 0xff][at % 3];
            if let Err(error) = Document::from_bytes("x", bytes, None, &LoadOptions::default()) {
                assert!(!error.to_string().contains("the decoder failed"), "byte {at}: {error}");
            }
        }
    }
}

#[test]
fn space_that_nothing_backs_is_not_allocated() {
    let name = "EXT_meshopt_compression";
    let (stream, ..) = every_filter().remove(0);
    let mut json = compressed(name, &vec![(stream, 3, 16, "ATTRIBUTES", "NONE"); 12]);
    for i in 0..12 {
        json["bufferViews"][i]["byteOffset"] = json!((48usize << 20) << i);
    }
    json["buffers"][1]["byteLength"] = json!(1u64 << 40);
    let error = decode(&json).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("larger gaps between"), "{error}");
}

#[test]
fn bounds_follow_lossy_filters() {
    let mut json = compressed("KHR_meshopt_compression", &every_filter());
    json["accessors"][0]["min"] = json!([0, -1, -0.60, 0]);
    json["accessors"][1]["min"] = json!([-9, -9, -9, -9]);
    let document = decode(&json).unwrap();
    let json = json_of(&document.to_glb().unwrap());
    let vectors = document.vectors::<4>(1).unwrap().into_owned();
    let least = |i: usize| f64::from(vectors.iter().map(|v| v[i]).fold(f32::INFINITY, f32::min));
    assert_eq!(json["accessors"][1]["min"], json!([0, 1, 2, 3].map(least)));
    assert_eq!(json["accessors"][0]["min"], json!([0, -1, -0.60, 0]), "as it was written");
}

/// A reader that parses the whole JSON once per view would take minutes.
#[test]
fn many_views_are_decoded() {
    let (stream, ..) = every_filter().remove(0);
    let json = compressed("EXT_meshopt_compression", &vec![(stream, 3, 16, "ATTRIBUTES", "NONE"); 10_000]);
    let document = decode(&json).unwrap();
    assert_eq!(document.vectors::<4>(9_999).unwrap()[..], VECTORS);
}

/// Draco with an uncompressed fallback in other order: the fallback is what other attributes of the primitive
/// follow.
#[test]
fn uncompressed_fallbacks_are_used() {
    let good = std::fs::read(asset("draco.glb")).unwrap();
    let plain = decompressed("draco.glb").to_glb().unwrap();
    let compressed = json_of(&good);
    let mut json = json_of(&plain);
    json["meshes"] = compressed["meshes"].clone();
    let bin = 28 + u32::from_le_bytes(plain[12..16].try_into().unwrap()) as usize;
    let uri = |bytes: &[u8]| {
        use base64::Engine;
        format!("data:;base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes))
    };
    json["buffers"][0]["uri"] = json!(uri(&plain[bin..]));
    let document = decode(&json).unwrap();
    assert_eq!(document.accessors().len(), 20);
    let written = json_of(&document.to_glb().unwrap());
    assert_eq!(written["accessors"], json["accessors"]);
    assert_eq!(written["bufferViews"], json["bufferViews"]);
    assert!(!written.to_string().contains("draco"));

    // Half a fallback has no order to follow.
    json["accessors"][2].as_object_mut().unwrap().remove("bufferView");
    let error = decode(&json).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("meshes[0].primitives[0]: is compressed in part only"), "{error}");
}

/// draco.glb as JSON whose buffer is embedded, with bytes appended to it.
fn draco_json(more: &[u8]) -> Value {
    use base64::Engine;
    let good = std::fs::read(asset("draco.glb")).unwrap();
    let mut json = json_of(&good);
    let start = 28 + u32::from_le_bytes(good[12..16].try_into().unwrap()) as usize;
    let bytes = [&good[start..], more].concat();
    let uri = base64::engine::general_purpose::STANDARD.encode(&bytes);
    json["buffers"][0] = json!({"byteLength": bytes.len(), "uri": format!("data:;base64,{uri}")});
    json
}

/// An accessor promises more or fewer elements than its stream has.
#[test]
fn counts_of_accessors_that_a_draco_stream_does_not_have_are_errors() {
    let json = draco_json(&[]);
    decode(&json).unwrap();
    let primitive = &json["meshes"][0]["primitives"][0];
    let indices = primitive["indices"].as_u64().unwrap() as usize;
    let vertices = || primitive["attributes"].as_object().unwrap().values();
    for change in [-3, 3, 3_000_000_000i64] {
        let changed = |accessors: &[usize]| {
            let mut json = json.clone();
            for &accessor in accessors {
                let count = &mut json["accessors"][accessor]["count"];
                *count = json!(count.as_i64().unwrap() + change);
            }
            decode(&json).map(|_| ()).unwrap_err().to_string()
        };
        let error = changed(&[indices]);
        assert!(error.contains(" indices but the stream has "), "{error}");
        let all: Vec<usize> = vertices().map(|accessor| accessor.as_u64().unwrap() as usize).collect();
        let error = changed(&all);
        assert!(error.contains(" elements but the stream has "), "{error}");
    }
}

/// The head of a stream promises two thousand million faces or vertices. The stream is an edgebreaker stream:
/// the numbers of vertices and faces follow twelve bytes, as numbers of seven bits per byte.
#[test]
fn counts_in_the_head_of_a_draco_stream_that_it_cannot_hold_are_errors() {
    const HEAD: usize = 12;
    const MANY: [u8; 5] = [0xff, 0xff, 0xff, 0xff, 0x07];
    let json = draco_json(&[]);
    let view = &json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["bufferView"];
    let view = view.as_u64().unwrap() as usize;
    let [start, length] = ["byteOffset", "byteLength"]
        .map(|member| json["bufferViews"][view][member].as_u64().unwrap_or(0) as usize);
    let good = std::fs::read(asset("draco.glb")).unwrap();
    let bin = 28 + u32::from_le_bytes(good[12..16].try_into().unwrap()) as usize;
    let stream = &good[bin + start..][..length];
    let number = |from: usize| from + 1 + stream[from..].iter().position(|byte| byte & 0x80 == 0).unwrap();
    let (faces, end) = (number(HEAD), number(number(HEAD)));
    for lie in [
        [&stream[..HEAD], &MANY, &stream[faces..]].concat(),
        [&stream[..faces], &MANY, &stream[end..]].concat(),
    ] {
        let offset = good.len() - bin;
        let mut json = draco_json(&lie);
        json["bufferViews"][view]["byteOffset"] = json!(offset);
        json["bufferViews"][view]["byteLength"] = json!(lie.len());
        let error = decode(&json).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("the stream is broken; compress the file again"), "{error}");
    }
}

#[test]
fn tangents_of_compressed_models_are_written_plain() {
    for (model, extension) in [("draco.glb", "draco"), ("meshopt.glb", "meshopt")] {
        let (mut document, decoded) = (open(model), decompressed(model));
        add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {}).unwrap();
        let written = document.to_glb().unwrap();
        assert!(!json_of(&written).to_string().contains(extension), "{model}");
        let again = Document::from_bytes("again", written, None, &LoadOptions::default()).unwrap();
        for primitive in 0..again.meshes()[0].primitives.len() {
            assert!(again.meshes()[0].primitives[primitive].attributes.contains_key("TANGENT"));
            assert_eq!(corners(&again, primitive), corners(&decoded, primitive), "{model}");
        }
    }
}

/// Nothing but positions, in a stream that has more: the accessors have no bytes of their own, and read as
/// zeros before they are decoded.
#[test]
fn attributes_of_a_draco_stream_that_a_primitive_lacks_are_skipped() {
    let mut json = draco_json(&[]);
    let whole = decode(&json).unwrap();
    for primitive in json["meshes"][0]["primitives"].as_array_mut().unwrap() {
        let attributes = primitive["attributes"].as_object_mut().unwrap();
        attributes.retain(|name, _| name == "POSITION");
    }
    let document = decode(&json).unwrap();
    for accessor in [1, 6, 11, 16] {
        assert_eq!(document.elements(accessor).unwrap(), whole.elements(accessor).unwrap());
    }
    assert_eq!(document.indices(0).unwrap().into_u32(), whole.indices(0).unwrap().into_u32());
    assert!(!json_of(&document.to_glb().unwrap()).to_string().contains("draco"));
}

/// One stream for two primitives, through the same accessors and through accessors of their own.
#[test]
fn primitives_share_a_draco_stream() {
    let mut json = draco_json(&[]);
    let first = json["meshes"][0]["primitives"][0].clone();
    let mut own = first.clone();
    let accessors = json["accessors"].as_array_mut().unwrap();
    for (place, accessor) in
        [("indices", 0), ("POSITION", 1), ("NORMAL", 2), ("TEXCOORD_0", 3), ("TEXCOORD_1", 4)]
    {
        accessors.push(accessors[accessor].clone());
        let place = if place == "indices" { &mut own["indices"] } else { &mut own["attributes"][place] };
        *place = json!(accessors.len() - 1);
    }
    json["meshes"][0]["primitives"].as_array_mut().unwrap().extend([first, own]);
    let document = decode(&json).unwrap();
    let all = corners(&document, 0);
    assert_eq!(corners(&document, 4), all);
    assert_eq!(corners(&document, 5), all);
    assert_eq!(document.meshes()[0].primitives[4].indices, Some(0), "accessors stay shared");
    assert_eq!(document.elements(2).unwrap(), document.elements(22).unwrap());
}

/// Several primitives, one as a morph target, over views of one meshopt buffer; one view has a fallback,
/// which is used.
#[test]
fn morph_targets_and_primitives_share_meshopt_views() {
    let name = "KHR_meshopt_compression";
    let mut json = compressed(name, &every_filter());
    for accessor in [0, 1] {
        json["accessors"][accessor]["type"] = json!("VEC3");
        json["bufferViews"][accessor]["byteStride"] = json!(16);
    }
    let primitive = json!({"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}]});
    json["meshes"] = json!([{"primitives": [primitive, {"attributes": {"POSITION": 1}}]}]);
    let document = decode(&json).unwrap();
    let xyz = VECTORS.map(|[x, y, z, _]| [x, y, z]);
    assert_eq!(document.vectors::<3>(0).unwrap()[..], xyz);
    for (found, expected) in document.vectors::<3>(1).unwrap().iter().zip(xyz) {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.02), "{found:?}");
    }

    use base64::Engine;
    let engine = base64::engine::general_purpose::STANDARD;
    let fallback = vec![0x3f; json["buffers"][1]["byteLength"].as_u64().unwrap() as usize];
    json["buffers"][1]["uri"] = json!(format!("data:;base64,{}", engine.encode(fallback)));
    let document = decode(&json).unwrap();
    assert_eq!(document.vectors::<3>(0).unwrap()[..], [[f32::from_bits(0x3f3f_3f3f); 3]; 3]);
    assert!(!json_of(&document.to_glb().unwrap()).to_string().contains("meshopt"));
}

/// A document that is only read keeps its compression where its text is kept; written into another container,
/// it has none, and no compressed bytes.
#[test]
fn documents_without_edits_keep_their_files() {
    let folder = tempfile::tempdir().unwrap();
    let stream = every_filter().remove(0);
    let length = stream.0.len();
    let mut json = compressed("EXT_meshopt_compression", std::slice::from_ref(&stream));
    json["buffers"][0] = json!({"byteLength": length, "uri": "model.bin"});
    json["meshes"] = json!([{"primitives": [{"attributes": {"COLOR_0": 0}}]}]);
    let [input, bin] = ["model.gltf", "model.bin"].map(|name| folder.path().join(name));
    std::fs::write(&input, json.to_string()).unwrap();
    std::fs::write(&bin, &stream.0).unwrap();
    let document = Document::open(&input, &LoadOptions::default()).unwrap();
    assert_eq!(document.vectors::<4>(0).unwrap()[..], VECTORS);
    assert_eq!(document.save_in_place().unwrap(), Vec::<PathBuf>::new());

    let output = folder.path().join("other/model.gltf");
    document.save(&output, &SaveOptions::default()).unwrap();
    assert_eq!(std::fs::read(&output).unwrap(), std::fs::read(&input).unwrap());
    assert_eq!(std::fs::read(output.with_extension("bin")).unwrap(), stream.0);

    let glb = document.to_glb().unwrap();
    let written = json_of(&glb);
    assert!(!written.to_string().contains("meshopt"), "{written}");
    assert_eq!(written["bufferViews"].as_array().unwrap().len(), 1);
    assert_eq!(written["buffers"], json!([{"byteLength": 48}]), "{written}");
    let plain = Document::from_bytes("plain", glb, None, &LoadOptions::default()).unwrap();
    assert_eq!(plain.vectors::<4>(0).unwrap()[..], VECTORS);
}

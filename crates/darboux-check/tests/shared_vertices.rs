//! Primitives that share many vertices of which each uses few: findings name the vertices of the file, and a
//! repair changes these.

mod support;

use darboux_check::{CheckOptions, Code, FixOptions, check_document, fix_document};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use serde_json::json;
use support::container::container;

/// Squares of their own vertices, so many.
const SQUARES: usize = 40;

/// A model of squares, each a primitive over the same accessors, with the tangents of some vertices changed.
fn model(change: impl Fn(usize, &mut [f32; 4])) -> Document {
    let corners = [[0.0f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let vertices: Vec<(usize, [f32; 2])> =
        (0..SQUARES).flat_map(|square| corners.map(|corner| (square, corner))).collect();
    let mut data: Vec<u8> = Vec::new();
    let mut views = Vec::new();
    let mut push = |bytes: Vec<u8>| {
        views.push(json!({ "buffer": 0, "byteOffset": data.len(), "byteLength": bytes.len() }));
        data.extend(bytes);
    };
    let floats = |values: Vec<f32>| values.into_iter().flat_map(f32::to_le_bytes).collect::<Vec<u8>>();
    push(floats(vertices.iter().flat_map(|&(square, [x, y])| [x + 2.0 * square as f32, y, 0.0]).collect()));
    push(floats(vertices.iter().flat_map(|_| [0.0, 0.0, 1.0]).collect()));
    push(floats(vertices.iter().flat_map(|&(_, [x, y])| [x, 1.0 - y]).collect()));
    let tangent = |vertex: usize| {
        let mut tangent = [1.0, 0.0, 0.0, 1.0];
        change(vertex, &mut tangent);
        tangent
    };
    push(floats((0..vertices.len()).flat_map(tangent).collect()));
    let indices = (0..SQUARES as u16).flat_map(|square| [0, 1, 2, 0, 2, 3].map(|corner| 4 * square + corner));
    push(indices.flat_map(u16::to_le_bytes).collect());
    let count = vertices.len();
    let attribute = |view: usize, kind: &str| json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind, "min": [0, 0, 0], "max": [0, 0, 0] });
    let mut accessors =
        vec![attribute(0, "VEC3"), attribute(1, "VEC3"), attribute(2, "VEC2"), attribute(3, "VEC4")];
    let mut primitives = Vec::new();
    for square in 0..SQUARES {
        primitives.push(json!({
            "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "TANGENT": 3 },
            "indices": accessors.len(),
            "material": 0,
        }));
        accessors.push(json!({ "bufferView": 4, "byteOffset": 12 * square, "componentType": 5123, "count": 6, "type": "SCALAR" }));
    }
    let json = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": data.len() }],
        "bufferViews": views,
        "accessors": accessors,
        "images": [{ "uri": "missing.png" }],
        "textures": [{ "source": 0 }],
        "materials": [{ "normalTexture": { "index": 0 } }],
        "meshes": [{ "primitives": primitives }],
    });
    let file = container(json.to_string().into_bytes(), data);
    Document::from_bytes("m.glb", file, None, &LoadOptions::default()).expect("a model")
}

/// The code, the place and the first items of the findings about tangents.
fn named(document: &Document) -> Vec<(Code, usize, Vec<usize>)> {
    let findings = check_document(document, &CheckOptions::default()).expect("findings");
    let of_primitives = findings.into_iter().filter_map(|finding| {
        let primitive = finding.place.primitive.as_ref()?.primitive;
        Some((finding.code, primitive, finding.first.clone()))
    });
    of_primitives.filter(|(code, ..)| code.to_string().starts_with("tangent")).collect()
}

#[test]
fn findings_name_the_vertices_of_the_file() {
    let document = model(|vertex, tangent| match vertex {
        41 => tangent[1] = f32::NAN,
        42 => *tangent = [0.0, 0.0, 0.0, 1.0],
        83 => tangent[3] = 0.5,
        127 => *tangent = [2.0, 0.0, 0.0, 1.0],
        _ => {}
    });
    let expected = [
        (Code::TangentNotFinite, 10, vec![41]),
        (Code::TangentZero, 10, vec![42]),
        (Code::TangentSignNotOne, 20, vec![83]),
        (Code::TangentNotUnit, 31, vec![127]),
    ];
    assert_eq!(named(&document), expected);
}

#[test]
fn repairs_change_the_vertices_of_the_file() {
    let mut document = model(|vertex, tangent| match vertex {
        41 => tangent[1] = f32::NAN,
        42 => *tangent = [0.0, 0.0, 0.0, 1.0],
        83 => tangent[3] = 0.5,
        127 => *tangent = [2.0, 0.0, 0.0, 1.0],
        _ => {}
    });
    let findings = check_document(&document, &CheckOptions::default()).expect("findings");
    fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
    assert_eq!(named(&document), []);
    for primitive in &document.meshes()[0].primitives {
        let indices = document.indices(primitive.indices.expect("indices")).expect("indices").into_u32();
        let tangents = document.vectors::<4>(primitive.attributes["TANGENT"]).expect("tangents");
        for vertex in indices {
            assert_eq!(tangents[vertex as usize], [1.0, 0.0, 0.0, 1.0], "{vertex}");
        }
    }
}

//! Primitives that share more vertices than they have corners are read at the vertices that they use, with
//! the values that a reader of all vertices finds.

mod support;

use darboux_io::LoadOptions;
use darboux_io::gltf::{Document, inspect};
use serde_json::{Value, json};
use support::glb;

const VERTICES: usize = 300;

/// A document of one buffer with these buffer views, accessors and indices of primitives over them: they are
/// positions, normals and UVs.
fn document(data: &[u8], views: Value, mut accessors: Vec<Value>, primitives: &[&[u16]]) -> Document {
    let mut data = data.to_vec();
    let mut views = views.as_array().expect("views").clone();
    let mut meshes = Vec::new();
    let semantics = ["POSITION", "NORMAL", "TEXCOORD_0"].into_iter().zip(0..accessors.len());
    let attributes: serde_json::Map<String, Value> =
        semantics.map(|(semantic, accessor)| (semantic.to_owned(), accessor.into())).collect();
    for indices in primitives {
        views.push(json!({ "buffer": 0, "byteOffset": data.len(), "byteLength": 2 * indices.len() }));
        data.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
        accessors.push(json!({ "bufferView": views.len() - 1, "componentType": 5123, "count": indices.len(), "type": "SCALAR" }));
        meshes.push(json!({ "primitives": [{ "attributes": attributes, "indices": accessors.len() - 1 }] }));
    }
    let json = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": data.len() }],
        "bufferViews": views,
        "accessors": accessors,
        "meshes": meshes,
    });
    let file = glb(&json.to_string(), &data);
    Document::from_bytes("m.glb", file, None, &LoadOptions::default()).expect("a model")
}

const FEW: [u16; 7] = [299, 7, 120, 7, 299, 13, 1];

/// Each primitive of a document must have the values at its corners that the accessor has there.
#[track_caller]
fn reads_its_own(document: &Document) {
    let all = document.vectors::<3>(0).expect("positions");
    for corners in document.corners().expect("corners") {
        let own = corners.used_vectors::<3>("POSITION").expect("positions").expect("positions");
        let at_corners: Vec<[f32; 3]> =
            corners.used_indices().iter().map(|&place| own[place as usize]).collect();
        let expected: Vec<[f32; 3]> = corners.vertices().iter().map(|&vertex| all[vertex as usize]).collect();
        assert_eq!(at_corners, expected);
        assert_eq!(corners.vectors::<3>("POSITION").expect("positions"), Some(expected));
        let vertices: Vec<u32> = match corners.used_vertices() {
            Some(vertices) => vertices.to_vec(),
            None => (0..own.len() as u32).collect(),
        };
        let named: Vec<u32> = corners.used_indices().iter().map(|&place| vertices[place as usize]).collect();
        assert_eq!(named, corners.vertices());
        assert!(own.len() <= corners.len(), "{} vertices of {} corners", own.len(), corners.len());
    }
}

fn bytes(count: usize) -> Vec<u8> {
    (0..count).map(|i| (i * 37 % 251) as u8).collect()
}

#[test]
fn interleaved_vertices_are_read() {
    let view = json!([{ "buffer": 0, "byteOffset": 0, "byteLength": 8 * VERTICES, "byteStride": 8 }]);
    let positions = |component: u32| {
        vec![json!({ "bufferView": 0, "byteOffset": 1, "componentType": component, "normalized": true,
            "count": VERTICES, "type": "VEC3" })]
    };
    let many: Vec<u16> = (0..VERTICES as u16).rev().collect();
    for component in [5120, 5121] {
        reads_its_own(&document(
            &bytes(8 * VERTICES),
            view.clone(),
            positions(component),
            &[&FEW, &many, &FEW[..3]],
        ));
    }
}

#[test]
fn sparse_vertices_are_read() {
    for (component, size) in [(5121, 1), (5123, 2), (5125, 4)] {
        for base in [None, Some(0)] {
            let mut data = bytes(12 * VERTICES + 36);
            for index in [7u32, 13, 200] {
                data.extend(&index.to_le_bytes()[..size]);
            }
            let views = json!([
                { "buffer": 0, "byteLength": 12 * VERTICES },
                { "buffer": 0, "byteOffset": 12 * VERTICES, "byteLength": 36 },
                { "buffer": 0, "byteOffset": 12 * VERTICES + 36, "byteLength": 3 * size },
            ]);
            let sparse = json!({ "count": 3, "indices": { "bufferView": 2, "componentType": component },
                "values": { "bufferView": 1 } });
            let mut accessor =
                json!({ "componentType": 5126, "count": VERTICES, "type": "VEC3", "sparse": sparse });
            if let Some(base) = base {
                accessor["bufferView"] = json!(base);
            }
            data.resize(data.len().next_multiple_of(4), 0);
            reads_its_own(&document(&data, views, vec![accessor], &[&FEW, &FEW[1..4]]));
        }
    }
}

/// Sparse indices that do not ascend are refused however few vertices are read.
#[test]
fn wrong_sparse_indices_are_refused() {
    let mut data = bytes(12 * VERTICES);
    data.extend([9, 7, 0, 0]);
    let views = json!([
        { "buffer": 0, "byteLength": 12 * VERTICES },
        { "buffer": 0, "byteOffset": 12 * VERTICES, "byteLength": 2 },
    ]);
    let sparse = json!({ "count": 2, "indices": { "bufferView": 1, "componentType": 5121 }, "values": { "bufferView": 0 } });
    let accessor = json!({ "componentType": 5126, "count": VERTICES, "type": "VEC3", "sparse": sparse });
    let document = document(&data, views, vec![accessor], &[&FEW]);
    for _ in 0..2 {
        let corners = document.corners().expect("corners");
        let error =
            corners[0].used_vectors::<3>("POSITION").expect_err("indices that do not ascend").to_string();
        assert!(error.contains("accessors[0].sparse.indices") && error.contains("not greater"), "{error}");
    }
}

/// The sentence names the index and the number of vertices in the file, where few or many of them are used.
#[test]
fn indices_out_of_range_are_refused() {
    let many: Vec<u16> = (0..VERTICES as u16 - 4).chain([999]).collect();
    for indices in [&[0, 1, 999], &many[..]] {
        let view = json!([{ "buffer": 0, "byteLength": 12 * VERTICES }]);
        let accessor =
            |kind: &str| json!({ "bufferView": 0, "componentType": 5126, "count": VERTICES, "type": kind });
        let accessors = ["VEC3", "VEC3", "VEC2"].map(accessor).to_vec();
        let document = document(&bytes(12 * VERTICES), view, accessors, &[indices]);
        let corners = document.corners().expect("corners");
        let sentence =
            corners[0].used_vectors::<3>("POSITION").expect_err("an index out of range").to_string();
        let place = indices.len() - 1;
        let problem = format!("index 999 at place {place} is out of range: there are {VERTICES} vertices");
        assert!(sentence.contains(&problem), "{sentence}");
        let at_corners = corners[0].vectors::<3>("POSITION").expect_err("an index out of range");
        assert_eq!(at_corners.to_string(), sentence);
        let inspected = inspect(&document).expect_err("an index out of range");
        assert_eq!(inspected.to_string(), sentence);
    }
}

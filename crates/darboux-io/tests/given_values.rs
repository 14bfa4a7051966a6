//! Values that the caller gives: tangents of corners, and vectors of vertices.

mod support;

use darboux_io::gltf::{Document, GivenTangents, PrimitiveName};
use serde_json::json;
use support::*;

fn name(mesh: usize) -> PrimitiveName {
    PrimitiveName { mesh, mesh_name: None, primitive: 0 }
}

/// Two meshes of the same two triangles over six vertices.
fn twice() -> Document {
    let mut builder = Builder::new();
    let attributes = butterfly().attributes(&mut builder);
    let indices = builder.indices(&BOTH);
    for _ in 0..2 {
        builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    }
    builder.build()
}

/// The tangents of the corners of a mesh as they are stored.
fn stored(document: &Document, mesh: usize) -> Vec<[f32; 4]> {
    let primitive = &document.meshes()[mesh].primitives[0];
    let tangents = document.vectors::<4>(primitive.attributes["TANGENT"]).unwrap();
    document
        .indices(primitive.indices.unwrap())
        .unwrap()
        .into_u32()
        .into_iter()
        .map(|at| tangents[at as usize])
        .collect()
}

const ONE: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const OTHER: [f32; 4] = [0.0, 0.0, -1.0, -1.0];

#[test]
fn corners_keep_the_tangents_that_they_are_given() {
    let mut document = twice();
    let given: Vec<[f32; 4]> = (0..BOTH.len()).map(|at| if at % 2 == 0 { ONE } else { OTHER }).collect();
    let (first, second) = ([name(0)], [name(1)]);
    let equal = vec![OTHER; BOTH.len()];
    document
        .set_corner_tangents(&[
            GivenTangents { primitives: &first, tangents: &given },
            GivenTangents { primitives: &second, tangents: &equal },
        ])
        .unwrap();
    assert_eq!(stored(&document, 0), given);
    assert_eq!(stored(&document, 1), equal);
}

#[test]
fn primitives_that_are_not_named_keep_what_they_have() {
    let mut document = twice();
    let before = document.json()["meshes"][1].clone();
    let tangents = vec![ONE; BOTH.len()];
    document.set_corner_tangents(&[GivenTangents { primitives: &[name(0)], tangents: &tangents }]).unwrap();
    assert_eq!(document.json()["meshes"][1], before);
}

#[test]
fn another_number_of_corners_is_refused() {
    let refused =
        twice().set_corner_tangents(&[GivenTangents { primitives: &[name(0)], tangents: &[ONE; 2] }]);
    let sentence = refused.unwrap_err().to_string();
    assert!(
        sentence.contains(&format!("has {} corners, but 2 tangents were given", BOTH.len())),
        "{sentence}"
    );
    let refused =
        twice().set_corner_tangents(&[GivenTangents { primitives: &[name(7)], tangents: &[ONE; 2] }]);
    let sentence = refused.unwrap_err().to_string();
    assert!(sentence.contains("meshes[7].primitives[0]"), "{sentence}");
}

#[test]
fn vertices_get_new_vectors_in_the_primitives_that_are_named() {
    let mut document = twice();
    let count = butterfly().positions.len();
    let raised: Vec<[f32; 3]> = (0..count).map(|at| [at as f32, 2.0, -1.0]).collect();
    document.set_positions(&[name(0)], &raised).unwrap();
    document.set_normals(&[name(0)], &vec![[0.0, 0.0, 1.0]; count]).unwrap();
    document.set_tangents(&[name(0)], &vec![ONE; count]).unwrap();
    let attributes = |mesh: usize| document.meshes()[mesh].primitives[0].attributes.clone();
    assert_eq!(*document.vectors::<3>(attributes(0)["POSITION"]).unwrap(), raised);
    let stored = &document.json()["accessors"][attributes(0)["POSITION"]];
    assert_eq!(stored["min"], [0.0, 2.0, -1.0]);
    assert_eq!(stored["max"], [5.0, 2.0, -1.0]);
    assert_ne!(attributes(0)["NORMAL"], attributes(1)["NORMAL"]);
    assert!(!attributes(1).contains_key("TANGENT"));
    let sentence = document.set_normals(&[name(1)], &[[0.0; 3]; 2]).unwrap_err().to_string();
    assert!(sentence.contains("has 6 vertices, but 2 of NORMAL were given"), "{sentence}");
}

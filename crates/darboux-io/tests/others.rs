//! Files of assimp and of three.js's exporters: corners with the bits of the glTF have its tangents, bit for
//! bit. docs/formats.md has the numbers.
#![cfg(all(feature = "obj", feature = "ply", feature = "stl"))]

use std::collections::HashMap;
use std::path::Path;

use darboux_io::LoadOptions;
use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents};

fn open(name: &str) -> Document {
    let path = Path::new("../../assets").join(name);
    Document::open(&path, &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Position, normal and UV.
type Key = [u32; 8];

/// The tangents of the corners by the bits of their other attributes. Several, where UVs are mirrored.
fn tangents(mut document: Document) -> HashMap<Key, Vec<[u32; 4]>> {
    let options = AddTangentsOptions::default().with_overwrite(true);
    add_tangents(&mut document, &options, &mut |_| {}).unwrap();
    let mut found: HashMap<Key, Vec<[u32; 4]>> = HashMap::new();
    for corners in document.corners().unwrap() {
        let positions = corners.vectors::<3>("POSITION").unwrap().unwrap();
        let normals = corners.vectors::<3>("NORMAL").unwrap().unwrap();
        let uvs = corners.vectors::<2>("TEXCOORD_0").unwrap().unwrap();
        let tangents = corners.vectors::<4>("TANGENT").unwrap().unwrap();
        for corner in 0..corners.len() {
            let (p, n, uv) = (positions[corner], normals[corner], uvs[corner]);
            // -0 and 0 are the same number.
            let key = [p[0], p[1], p[2], n[0], n[1], n[2], uv[0], uv[1]].map(|x| (x + 0.0).to_bits());
            found.entry(key).or_default().push(tangents[corner].map(|x| (x + 0.0).to_bits()));
        }
    }
    for tangents in found.values_mut() {
        tangents.sort_unstable();
        tangents.dedup();
    }
    found
}

/// The distinct corners of the first file; of those, the ones that the second file has, and the ones with the
/// same tangents in both.
fn compared(gltf: &str, other: &str) -> [usize; 3] {
    let [gltf, other] = [gltf, other].map(|name| tangents(open(name)));
    let common = gltf.keys().filter(|key| other.contains_key(*key)).count();
    let same = gltf.iter().filter(|(key, tangents)| other.get(*key) == Some(tangents)).count();
    [gltf.len(), common, same]
}

#[test]
fn corners_of_assimp_have_the_tangents_of_the_gltf() {
    let scene = "blender/scene.z-up.glb";
    for (name, common) in [("glb", 74), ("obj", 54), ("ply", 54), ("binary.ply", 54)] {
        assert_eq!(compared(scene, &format!("others/assimp.{name}")), [74, common, common], "{name}");
    }
    #[cfg(feature = "fbx")]
    assert_eq!(compared(scene, "others/assimp.fbx"), [74, 20, 20]);
}

#[test]
fn corners_of_three_have_the_tangents_of_the_gltf() {
    let found = ["obj", "ply", "binary.ply", "big-endian.ply"]
        .map(|name| compared("others/three.glb", &format!("others/three.{name}")));
    assert_eq!(found, [[159, 159, 159]; 4]);
}

#[test]
fn stl_of_both_has_the_triangles() {
    let triangles = |name: &str| {
        let document = open(name);
        document.corners().unwrap().iter().map(|corners| corners.len() / 3).sum::<usize>()
    };
    for name in ["assimp.stl", "assimp.binary.stl"] {
        assert_eq!(triangles(&format!("others/{name}")), 100, "{name}");
    }
    let of_gltf = triangles("others/three.glb");
    for name in ["three.stl", "three.binary.stl"] {
        assert_eq!(triangles(&format!("others/{name}")), of_gltf, "{name}");
    }
}

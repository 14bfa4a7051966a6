//! Everything of Blender's scene beside its tangents: the second UV set, the shapes and the skin of the FBX
//! are those of the glTF of the same scene.
#![cfg(feature = "fbx")]

use std::collections::HashMap;
use std::path::Path;

use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use darboux_io::json::Value;

fn open(name: &str) -> Document {
    Document::open(&Path::new("../../assets/blender").join(name), &LoadOptions::default()).unwrap()
}

fn bits<const N: usize>(value: [f32; N]) -> [u32; N] {
    value.map(|x| (x + 0.0).to_bits())
}

/// What a vertex has besides its position, normal and first UV.
#[derive(Clone, Debug, PartialEq)]
struct Rest {
    second_uv: [u32; 2],
    /// The offsets of the shapes, in millionths.
    offsets: Vec<[i64; 3]>,
    /// The weights by the name of the joint, in millionths; those of 0 left out.
    weights: Vec<(String, i64)>,
}

fn millionths(x: f32) -> i64 {
    (f64::from(x) * 1e6).round() as i64
}

/// The primitive of the mesh `Sheet`.
fn sheet(document: &Document) -> &Value {
    let meshes = document.json()["meshes"].as_array().unwrap();
    &meshes.iter().find(|mesh| mesh["name"] == "Sheet").unwrap()["primitives"][0]
}

/// The names of the joints of the only skin.
fn joints(document: &Document) -> Vec<String> {
    let json = document.json();
    let joints = json["skins"][0]["joints"].as_array().unwrap();
    let name =
        |joint: &Value| json["nodes"][joint.as_u64().unwrap() as usize]["name"].as_str().unwrap().to_owned();
    joints.iter().map(name).collect()
}

fn vertices(document: &Document) -> HashMap<[u32; 8], Rest> {
    let primitive = sheet(document);
    let accessor =
        |name: &str| primitive["attributes"][name].as_u64().unwrap_or_else(|| panic!("{name}")) as usize;
    let [positions, normals] =
        ["POSITION", "NORMAL"].map(|name| document.vectors::<3>(accessor(name)).unwrap().into_owned());
    let [uvs, seconds] =
        ["TEXCOORD_0", "TEXCOORD_1"].map(|name| document.vectors::<2>(accessor(name)).unwrap().into_owned());
    let [joints_of_vertex, weights] =
        ["JOINTS_0", "WEIGHTS_0"].map(|name| document.vectors::<4>(accessor(name)).unwrap().into_owned());
    let targets: Vec<_> = primitive["targets"].as_array().unwrap().iter().collect();
    let offsets: Vec<_> = targets
        .iter()
        .map(|target| {
            document.vectors::<3>(target["POSITION"].as_u64().unwrap() as usize).unwrap().into_owned()
        })
        .collect();
    let names = joints(document);
    let rest = |i: usize| {
        let pairs = joints_of_vertex[i].into_iter().zip(weights[i]).filter(|(_, weight)| *weight > 0.0);
        let mut weights: Vec<_> =
            pairs.map(|(joint, weight)| (names[joint as usize].clone(), millionths(weight))).collect();
        weights.sort_unstable();
        Rest {
            second_uv: bits(seconds[i]),
            offsets: offsets.iter().map(|offsets| offsets[i].map(millionths)).collect(),
            weights,
        }
    };
    let key = |i: usize| {
        let ([a, b, c], [d, e, f], [g, h]) = (bits(positions[i]), bits(normals[i]), bits(uvs[i]));
        [a, b, c, d, e, f, g, h]
    };
    (0..positions.len()).map(|i| (key(i), rest(i))).collect()
}

#[test]
fn second_uvs_shapes_and_weights_are_those_of_the_gltf() {
    let (fbx, gltf) = (open("scene.fbx"), open("scene.z-up.glb"));
    let (of_fbx, of_gltf) = (vertices(&fbx), vertices(&gltf));
    assert_eq!(of_fbx.len(), 54);
    assert_eq!(of_fbx.len(), of_gltf.len());
    for (key, expected) in &of_gltf {
        assert_eq!(of_fbx.get(key), Some(expected));
    }
    let moved = |shape: usize| of_fbx.values().filter(|rest| rest.offsets[shape] != [0; 3]).count();
    assert!(moved(0) > 20 && moved(1) > 20, "both shapes move vertices");
    assert!(of_fbx.values().any(|rest| rest.weights.len() == 2), "vertices between the bones");
    assert!(of_fbx.values().any(|rest| rest.second_uv != [0; 2]));
    let names = |document: &Document| {
        let meshes = document.json()["meshes"].as_array().unwrap();
        meshes.iter().find(|mesh| mesh["name"] == "Sheet").unwrap()["extras"]["targetNames"].to_string()
    };
    assert_eq!(names(&fbx), names(&gltf));
}

/// The vertices of the sheet in the scene, after the second bone was turned about an axis of the scene: by
/// the second UV, which tells vertices apart.
fn posed(document: &Document) -> HashMap<[u32; 2], [f64; 3]> {
    let scene = document.mesh_instances().unwrap();
    let instance = scene.meshes.iter().find(|instance| instance.skin.is_some()).unwrap();
    let matrices = &scene.skins[instance.skin.unwrap()];
    let names = joints(document);
    let primitive = sheet(document);
    let accessor = |name: &str| primitive["attributes"][name].as_u64().unwrap() as usize;
    let positions = document.vectors::<3>(accessor("POSITION")).unwrap();
    let seconds = document.vectors::<2>(accessor("TEXCOORD_1")).unwrap();
    let joints_of_vertex = document.vectors::<4>(accessor("JOINTS_0")).unwrap();
    let weights = document.vectors::<4>(accessor("WEIGHTS_0")).unwrap();
    let at = |i: usize| {
        let mut sum = [0.0; 3];
        for (joint, weight) in joints_of_vertex[i].into_iter().zip(weights[i]) {
            let matrix = matrices[joint as usize];
            let [x, y, z] = positions[i].map(f64::from);
            let mut moved =
                [0, 1, 2].map(|k| matrix[0][k] * x + matrix[1][k] * y + matrix[2][k] * z + matrix[3][k]);
            if names[joint as usize] == "Right" {
                let (sin, cos) = 0.5f64.sin_cos();
                moved = [cos * moved[0] - sin * moved[1], sin * moved[0] + cos * moved[1], moved[2]];
            }
            sum = [0, 1, 2].map(|k| sum[k] + f64::from(weight) * moved[k]);
        }
        sum
    };
    (0..positions.len()).map(|i| (bits(seconds[i]), at(i))).collect()
}

/// The scene with y up, in metres, as both files say.
#[test]
fn skins_move_vertices_alike() {
    let (of_fbx, of_gltf) = (posed(&open("scene.fbx")), posed(&open("scene.glb")));
    assert_eq!((of_fbx.len(), of_gltf.len()), (54, 54));
    for (uv, expected) in &of_gltf {
        let found = of_fbx[uv];
        let difference = (0..3).map(|i| (found[i] - expected[i]).abs()).fold(0.0, f64::max);
        assert!(difference < 1e-5, "{found:?}, not {expected:?}");
    }
}

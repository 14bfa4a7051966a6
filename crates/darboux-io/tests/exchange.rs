//! Documents as PLY and OBJ: read again, they have the same faces and frames; what they cannot hold is
//! listed.
#![cfg(all(feature = "obj", feature = "ply"))]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents};
use darboux_io::source::FaceCounts;
use darboux_io::{FileKind, LoadOptions, SaveOptions};
use serde_json::json;

fn blender(name: &str) -> PathBuf {
    Path::new("../../assets/blender").join(name)
}

fn open(path: &Path) -> Document {
    Document::open(path, &LoadOptions::default()).unwrap()
}

/// A document with tangents of its own.
fn with_tangents(path: &Path) -> Document {
    let mut document = open(path);
    let options = AddTangentsOptions::default().with_overwrite(true);
    add_tangents(&mut document, &options, &mut |_| {}).unwrap();
    document
}

fn saved(document: &Document, path: &Path) -> Document {
    document.save(path, &SaveOptions::default()).unwrap();
    open(path)
}

/// A position, a normal and, where asked for, a tangent.
type Frame = ([u32; 3], [u32; 3], [u32; 4]);

/// The bits of all corners' frames, zeros without their sign.
fn frames(document: &Document, with_tangents: bool) -> Vec<Frame> {
    fn bits<const N: usize>(value: [f32; N]) -> [u32; N] {
        value.map(|x| (x + 0.0).to_bits())
    }
    let mut frames = Vec::new();
    for corners in document.corners().unwrap() {
        let positions = corners.vectors::<3>("POSITION").unwrap().unwrap();
        let normals = corners.vectors::<3>("NORMAL").unwrap().unwrap();
        let tangents = corners.vectors::<4>("TANGENT").unwrap().filter(|_| with_tangents);
        frames.extend((0..corners.len()).map(|corner| {
            let tangent = tangents.as_ref().map_or([0; 4], |tangents| bits(tangents[corner]));
            (bits(positions[corner]), bits(normals[corner]), tangent)
        }));
    }
    frames.sort_unstable();
    frames
}

#[test]
fn a_ply_has_the_frames_and_quads_of_its_source() {
    let folder = tempfile::tempdir().unwrap();
    let source = with_tangents(&blender("scene.obj"));
    let ply = saved(&source, &folder.path().join("scene.ply"));
    assert_eq!(frames(&source, true), frames(&ply, true));
    let FaceCounts { triangles, quads, polygons, .. } = source.provenance().unwrap().faces;
    let found = ply.provenance().unwrap().faces;
    assert_eq!((found.quads, found.polygons), (quads, 0));
    assert!(polygons > 0 && found.triangles > triangles, "larger faces stay cut");
    assert_eq!(source.left_out(FileKind::Ply).unwrap(), ["1 material", "1 texture"]);
}

/// The scene has a turned root, and a mesh at a mirrored place.
#[test]
fn transforms_turn_frames_and_mirrored_faces() {
    let folder = tempfile::tempdir().unwrap();
    let ply = folder.path().join("scene.ply");
    let given = saved(&with_tangents(&blender("scene.glb")), &ply);
    let computed = with_tangents(&ply);
    let pairs = given.corners().unwrap().into_iter().zip(computed.corners().unwrap());
    let (mut corners, mut turned) = (0, 0);
    for (given, computed) in pairs {
        let [positions, normals] =
            ["POSITION", "NORMAL"].map(|name| given.vectors::<3>(name).unwrap().unwrap());
        let [ours, theirs] = [given, computed].map(|found| found.vectors::<4>("TANGENT").unwrap().unwrap());
        for (triangle, [a, b, c]) in positions.as_chunks::<3>().0.iter().enumerate() {
            let [d, e] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
            let face = [0, 1, 2].map(|i| d[(i + 1) % 3] * e[(i + 2) % 3] - d[(i + 2) % 3] * e[(i + 1) % 3]);
            let normal = normals[3 * triangle];
            turned += usize::from((0..3).map(|i| face[i] * normal[i]).sum::<f32>() <= 0.0);
        }
        for (ours, theirs) in ours.iter().zip(&theirs) {
            let is_near = (0..3).all(|i| (ours[i] - theirs[i]).abs() < 1e-4);
            // Two corners of the triangle without UV area have a tangent of their own choice.
            corners += usize::from(is_near && ours[3] == theirs[3]);
        }
    }
    assert!(corners >= 298, "{corners} of 300 corners");
    assert_eq!(turned, 1, "a sliver of a larger face, as in the source");
}

#[test]
fn an_obj_has_the_faces_materials_and_textures_of_its_source() {
    let folder = tempfile::tempdir().unwrap();
    let source = with_tangents(&blender("scene.obj"));
    fs::write(folder.path().join("chair.mtl"), "of another model").unwrap();
    let written = source.save(&folder.path().join("chair.obj"), &SaveOptions::default()).unwrap();
    let names: Vec<_> = written.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["scene_normal.png", "chair_1.mtl", "chair.obj"]);
    assert_eq!(fs::read(&written[0]).unwrap(), fs::read(blender("scene_normal.png")).unwrap());
    let obj = open(&written[2]);
    assert_eq!(frames(&source, false), frames(&obj, false));
    assert_eq!(obj.provenance().unwrap().faces.quads, source.provenance().unwrap().faces.quads);
    let [ours, theirs] = [&source, &obj].map(|document| document.materials().unwrap());
    // They go through sRGB.
    let mut colors = ours[0].base_color.into_iter().zip(theirs[0].base_color);
    assert!(colors.all(|(ours, theirs)| (ours - theirs).abs() < 1e-6));
    assert_eq!((ours[0].metallic, ours[0].roughness), (theirs[0].metallic, theirs[0].roughness));
    assert!(theirs[0].normal_texture.is_some());
    let lost = "the tangents, for which OBJ has no place: an importer computes its own";
    assert_eq!(source.left_out(FileKind::Obj).unwrap(), [lost]);
}

/// Of a scene with what PLY and OBJ lack.
#[test]
fn what_is_left_out_is_listed() {
    let mut gltf: BTreeMap<&str, serde_json::Value> = BTreeMap::new();
    gltf.insert("asset", json!({"version": "2.0"}));
    gltf.insert("accessors", json!([{"componentType": 5126, "count": 3, "type": "VEC3"}]));
    let primitive = |mode: u32, attributes: &[&str]| {
        let attributes: BTreeMap<&str, u32> = attributes.iter().map(|name| (*name, 0)).collect();
        json!({"mode": mode, "attributes": attributes, "targets": [{"POSITION": 0}]})
    };
    let primitives =
        [primitive(4, &["POSITION", "NORMAL"]), primitive(4, &["POSITION"]), primitive(1, &["POSITION"])];
    gltf.insert("meshes", json!([{"primitives": primitives}, {"primitives": [primitive(4, &["POSITION"])]}]));
    gltf.insert("nodes", json!([{"mesh": 0}]));
    gltf.insert("scenes", json!([{"nodes": [0]}]));
    let camera = json!({"type": "perspective", "perspective": {"yfov": 1, "znear": 1}});
    gltf.insert("cameras", json!([camera, camera]));
    gltf.insert("extensionsUsed", json!(["KHR_lights_punctual"]));
    let bytes = serde_json::to_vec(&gltf).unwrap();
    let document = Document::from_bytes("model", bytes, None, &LoadOptions::default()).unwrap();
    let common = [
        "1 morph target",
        "2 cameras",
        "1 mesh outside the scene",
        "1 primitive of points or lines",
        "KHR_lights_punctual",
    ];
    assert_eq!(document.left_out(FileKind::Obj).unwrap(), common);
    let mut of_ply = vec!["the lack of normals on some surfaces, where they are 0"];
    of_ply.extend(common);
    assert_eq!(document.left_out(FileKind::Ply).unwrap(), of_ply);
    assert!(document.left_out(FileKind::Glb).unwrap().is_empty());
}

/// MTL moves, scales and clamps textures, and does not rotate them. The texture's v points up in it.
#[test]
fn textures_of_an_obj_lie_as_in_the_document() {
    let folder = tempfile::tempdir().unwrap();
    let document = open(&blender("mapping.glb"));
    assert_eq!(
        document.left_out(FileKind::Obj).unwrap(),
        ["2 placements of textures, which are rotated", "8 double-sided materials"]
    );
    let obj = saved(&document, &folder.path().join("mapping.obj"));
    assert_eq!(obj.warnings(), [""; 0]);
    let library = fs::read_to_string(folder.path().join("mapping.mtl")).unwrap();
    assert!(library.contains("map_Kd -o -0.5 -0.5 0 -s 2 4 1 "), "{library}");
    let placements = |document: &Document| {
        let names = document.json()["materials"]
            .as_array()
            .unwrap()
            .iter()
            .map(|material| material["name"].as_str().unwrap().replace(' ', "_"));
        let textures = document.materials().unwrap().into_iter().map(|material| {
            let texture = material.base_texture.unwrap();
            let uvs = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|uv| texture.transform_uv(uv));
            (uvs, texture.wrap)
        });
        names.zip(textures).collect::<BTreeMap<_, _>>()
    };
    let (mut wanted, found) = (placements(&document), placements(&obj));
    let plain = wanted["plain"];
    wanted.extend(["turned", "all"].map(|name| (name.to_owned(), plain)));
    assert_eq!(found, wanted);
}

/// A texture may lie on other UVs than the tangents, and may be mirrored along one axis.
#[test]
fn attributes_without_a_place_are_listed() {
    let accessor = |kind: &str| json!({"componentType": 5126, "count": 3, "type": kind});
    let attributes = json!({"POSITION": 0, "COLOR_0": 1, "COLOR_1": 1, "_HEAT": 0, "_WEAR": 0});
    let gltf = json!({
        "asset": {"version": "2.0"},
        "accessors": [accessor("VEC3"), accessor("VEC4")],
        "meshes": [{"primitives": [{"attributes": attributes}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
    });
    let options = LoadOptions::default();
    let document = Document::from_bytes("a.gltf", gltf.to_string().into(), None, &options).unwrap();
    let [colors, attributes] = ["1 further set of colours", "2 custom attributes"];
    assert_eq!(
        document.left_out(FileKind::Obj).unwrap(),
        [colors, "the alpha of vertex colours", attributes]
    );
    assert_eq!(document.left_out(FileKind::Ply).unwrap(), [colors, attributes]);
}

/// Half a turn is a negative scale; other rotations have no option.
#[test]
fn half_turns_of_textures_are_written() {
    let document = |rotation: f32| {
        let transform = json!({"offset": [0.25, 0.5], "rotation": rotation, "scale": [2, 4]});
        let texture = json!({"index": 0, "extensions": {"KHR_texture_transform": transform}});
        let gltf = json!({
            "asset": {"version": "2.0"},
            "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3"}],
            "images": [{"uri": "scene_normal.png"}],
            "textures": [{"source": 0}],
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": texture}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
            "nodes": [{"mesh": 0}],
            "scenes": [{"nodes": [0]}],
        });
        let folder = blender("");
        let (bytes, options) = (gltf.to_string().into(), LoadOptions::default());
        Document::from_bytes("a.gltf", bytes, Some(&folder), &options).unwrap()
    };
    let folder = tempfile::tempdir().unwrap();
    let half = document(std::f32::consts::PI);
    let obj = saved(&half, &folder.path().join("half.obj"));
    let [ours, theirs] = [&half, &obj].map(|document| {
        let texture = document.materials().unwrap()[0].base_texture.clone().unwrap();
        texture.transform_uv([0.75, 0.125])
    });
    assert!(
        ours.iter().zip(theirs).all(|(ours, theirs)| (ours - theirs).abs() < 1e-5),
        "{ours:?} {theirs:?}"
    );
    assert_eq!(half.left_out(FileKind::Obj).unwrap(), [""; 0]);
    let lost = document(0.5).left_out(FileKind::Obj).unwrap();
    assert_eq!(lost, ["1 placement of a texture, which is rotated"]);
}

#[test]
fn what_an_obj_cannot_say_of_textures_is_listed() {
    let gltf = json!({
        "asset": {"version": "2.0"},
        "samplers": [{"wrapS": 33648, "magFilter": 9728}],
        "images": [{"uri": "a.png"}],
        "textures": [{"source": 0, "sampler": 0}, {"source": 0}],
        "materials": [{
            "alphaMode": "MASK",
            "doubleSided": true,
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": 0},
                "metallicRoughnessTexture": {"index": 1, "texCoord": 1},
            },
            "normalTexture": {"index": 1},
        }],
    });
    let bytes = serde_json::to_vec(&gltf).unwrap();
    let document = Document::from_bytes("model", bytes, None, &LoadOptions::default()).unwrap();
    let wanted = [
        "1 choice to mirror a texture, or to clamp it along one axis",
        "1 texture on a UV set that is not written",
        "2 textures whose images cannot be read",
        "1 use of a texture's alpha",
        "1 texture filter of single texels",
        "1 alpha mask",
        "1 double-sided material",
    ];
    assert_eq!(document.left_out(FileKind::Obj).unwrap(), wanted);
}

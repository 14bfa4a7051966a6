//! OBJ, PLY and STL: what Blender wrote gives the tangents of its glTF, faces of any size are cut, and other
//! files are named for what they are.
#![cfg(all(feature = "obj", feature = "ply", feature = "stl"))]

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents};
use darboux_io::source::{FaceCounts, PolygonRule};
use darboux_io::{LoadOptions, SaveOptions};

fn blender(name: &str) -> PathBuf {
    Path::new("../../assets/blender").join(name)
}

fn open(path: &Path) -> Document {
    Document::open(path, &LoadOptions::default()).unwrap()
}

fn read(bytes: impl Into<Vec<u8>>) -> Document {
    Document::from_bytes("model", bytes.into(), None, &LoadOptions::default()).unwrap()
}

fn refusal(bytes: impl Into<Vec<u8>>) -> String {
    Document::from_bytes("model", bytes.into(), None, &LoadOptions::default()).unwrap_err().to_string()
}

/// The bits of a corner's position and UV, and its normal in units of four decimals, which are all that OBJ
/// has.
type CornerKey = ([u32; 5], [i32; 3]);

/// The normal and the tangent of all corners, by their keys.
fn corners_of(mut document: Document) -> HashMap<CornerKey, ([f32; 3], [f32; 4])> {
    add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {}).unwrap();
    let mut found = HashMap::new();
    for corners in document.corners().unwrap() {
        let positions = corners.vectors::<3>("POSITION").unwrap().unwrap();
        let normals = corners.vectors::<3>("NORMAL").unwrap().unwrap();
        let uvs = corners.vectors::<2>("TEXCOORD_0").unwrap().unwrap();
        let tangents = corners.vectors::<4>("TANGENT").unwrap().unwrap();
        for corner in 0..corners.len() {
            // Zeros of both signs are the same number.
            let [x, y, z] = positions[corner].map(|x| (x + 0.0).to_bits());
            let [u, v] = uvs[corner].map(|x| (x + 0.0).to_bits());
            let normal = normals[corner].map(|x| (1e4 * x).round() as i32);
            // The middle of the sheet is mirrored: its corners have two tangents, which the sign tells apart.
            if positions[corner][0] != 0.0 {
                found.insert(([x, y, z, u, v], normal), (normals[corner], tangents[corner]));
            }
        }
    }
    found
}

/// The corners of the sheet that both documents have: their number, how many have the same normals by bits,
/// how many of those the same tangents, and the largest difference between tangents.
fn compared(a: &str, b: &str) -> (usize, usize, usize, f32) {
    let [a, b] = [a, b].map(|name| corners_of(open(&blender(name))));
    let (mut common, mut same_normals, mut same_tangents, mut largest) = (0, 0, 0, 0.0f32);
    for (key, (normal, tangent)) in &a {
        let Some((other_normal, other)) = b.get(key) else { continue };
        common += 1;
        same_normals += usize::from(normal == other_normal);
        same_tangents += usize::from(normal == other_normal && tangent == other);
        largest = tangent.iter().zip(other).fold(largest, |largest, (a, b)| largest.max((a - b).abs()));
    }
    (common, same_normals, same_tangents, largest)
}

#[test]
fn the_formats_of_a_scene_have_the_same_tangents() {
    let obj = compared("scene.obj", "scene.glb");
    assert!(obj.0 > 40 && obj.3 < 2e-4, "OBJ: {obj:?}");
    let ply = compared("scene.ply", "scene.z-up.glb");
    assert!(ply.0 > 40 && ply.3 < 1e-6, "PLY: {ply:?}");
    assert!(ply.1 > 0 && ply.1 == ply.2, "PLY: {ply:?}");
}

/// A glTF whose triangles are written as a PLY with the same bits.
#[test]
fn the_same_bits_give_the_same_tangents() {
    let mut document = open(&blender("scene.z-up.glb"));
    add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {}).unwrap();
    for corners in document.corners().unwrap() {
        let positions = corners.vectors::<3>("POSITION").unwrap().unwrap();
        let normals = corners.vectors::<3>("NORMAL").unwrap().unwrap();
        let uvs = corners.vectors::<2>("TEXCOORD_0").unwrap().unwrap();
        let count = corners.len();
        let properties: String = ["x", "y", "z", "nx", "ny", "nz", "s", "t"]
            .map(|name| format!("property float {name}\n"))
            .concat();
        let mut ply = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{properties}element face {}\n\
            property list uchar int vertex_indices\nend_header\n",
            count / 3
        )
        .into_bytes();
        for corner in 0..count {
            let [u, v] = uvs[corner];
            let numbers = [&positions[corner][..], &normals[corner], &[u, 1.0 - v]].concat();
            ply.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        }
        for triangle in 0..count as i32 / 3 {
            ply.push(3);
            ply.extend([0, 1, 2].iter().flat_map(|corner| (3 * triangle + corner).to_le_bytes()));
        }
        let mut read = read(ply);
        add_tangents(&mut read, &AddTangentsOptions::default(), &mut |_| {}).unwrap();
        let found = read.corners().unwrap()[0].vectors::<4>("TANGENT").unwrap().unwrap();
        let bits = |tangents: &[[f32; 4]]| tangents.iter().map(|t| t.map(f32::to_bits)).collect::<Vec<_>>();
        assert_eq!(bits(&found), bits(&corners.vectors::<4>("TANGENT").unwrap().unwrap()));
    }
}

#[test]
fn a_scene_keeps_its_faces_and_materials() {
    let document = open(&blender("scene.obj"));
    assert_eq!(document.warnings(), [""; 0]);
    let provenance = document.provenance().unwrap();
    let FaceCounts { triangles, quads, polygons, folded, .. } = provenance.faces;
    assert!(triangles > 0 && quads > 0 && polygons == 4 && folded == 0, "{:?}", provenance.faces);
    assert_eq!(provenance.generator.as_deref(), Some("Blender 5.0.1"));
    assert_eq!(provenance.primitive(0, 0).unwrap().path, "o Body");
    let materials = document.materials().unwrap();
    assert_eq!(materials.len(), 1);
    assert!(document.json()["materials"][0]["normalTexture"].is_object());
    assert_eq!(document.json()["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"], 0.75);
}

#[test]
fn stl_has_the_triangles_of_the_scene() {
    let document = open(&blender("scene.stl"));
    let triangles: usize = document.corners().unwrap().iter().map(|corners| corners.len() / 3).sum();
    assert_eq!(triangles, 100);
}

const SQUARE: [[f32; 5]; 4] = [
    [0.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0, 1.0, 0.0],
    [1.0, 1.0, 0.0, 1.0, 1.0],
    [0.0, 1.0, 0.0, 0.0, 1.0],
];

const VERTICES: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float s\nproperty float t\n";

/// A square of one face as a PLY in an encoding.
fn square(encoding: &str) -> Vec<u8> {
    let faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let mut ply = format!("ply\nformat {encoding} 1.0\n{VERTICES}{faces}").into_bytes();
    match encoding {
        "ascii" => ply.extend(b"0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n"),
        _ => {
            let is_little = encoding == "binary_little_endian";
            ply.extend(
                SQUARE
                    .iter()
                    .flatten()
                    .flat_map(|x| if is_little { x.to_le_bytes() } else { x.to_be_bytes() }),
            );
            ply.push(4);
            ply.extend((0..4i32).flat_map(|i| if is_little { i.to_le_bytes() } else { i.to_be_bytes() }));
        }
    }
    ply
}

#[test]
fn all_encodings_of_ply_are_one_model() {
    let glbs = ["ascii", "binary_little_endian", "binary_big_endian"].map(|encoding| {
        let document = read(square(encoding));
        assert_eq!(document.provenance().unwrap().faces.quads, 1);
        document.to_glb().unwrap()
    });
    assert!(glbs[0] == glbs[1] && glbs[1] == glbs[2]);
}

#[test]
fn cut_off_and_untrue_counts_are_errors() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let whole = square(encoding);
        for length in 0..whole.len() - 1 {
            let cut = Document::from_bytes("model", whole[..length].to_vec(), None, &LoadOptions::default());
            assert!(cut.is_err(), "{encoding}: {length} bytes");
        }
    }
    let huge = String::from_utf8(square("ascii")).unwrap().replace("vertex 4", "vertex 4000000000");
    assert!(
        refusal(huge)
            .contains("element vertex: the file is cut off: its header says that there are 4000000000")
    );
    let outside = String::from_utf8(square("ascii")).unwrap().replace("4 0 1 2 3", "4 0 1 2 9");
    assert!(refusal(outside).contains("a face refers to position 9, but there are 4"));
    // Elements that could each be there, but not all.
    let faces = "element face 20\nproperty list uchar int vertex_indices\n".repeat(300);
    let many =
        String::from_utf8(square("ascii")).unwrap().replace("end_header", &format!("{faces}end_header"));
    assert!(refusal(many).contains("element face: the file is cut off: its header says that there are 20"));
}

/// A million of them would otherwise take a second each, and memory as faces.
#[test]
fn elements_without_properties_have_no_data() {
    let empty = "element face 4000000000\nelement other 4000000000\n".repeat(1000);
    let ply =
        String::from_utf8(square("ascii")).unwrap().replace("end_header", &format!("{empty}end_header"));
    assert_eq!(read(ply).provenance().unwrap().faces.quads, 1);
}

#[test]
fn ascii_and_binary_stl_are_one_model() {
    let ascii = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    let mut binary = vec![0; 80];
    binary.extend(1u32.to_le_bytes());
    let numbers = [0.0f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    binary.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    binary.extend([0, 0]);
    let positions = |document: &Document| document.corners().unwrap()[0].vectors::<3>("POSITION").unwrap();
    assert_eq!(positions(&read(ascii)), positions(&read(binary.clone())));
    // A header that begins with "solid" is no ASCII file.
    binary[..5].copy_from_slice(b"solid");
    assert_eq!(positions(&read(ascii)), positions(&read(binary)));
    assert!(refusal(&ascii[..ascii.len() - 12]).contains("cut off before endsolid"));
}

/// Whatever the ending says: the content decides, and an empty file is empty.
#[test]
fn endings_do_not_decide() {
    let folder = tempfile::tempdir().unwrap();
    for (content, name, words) in [
        ("scene.obj", "a.glb", "OBJ"),
        ("scene.ply", "a.fbx", "PLY"),
        ("scene.stl", "a.obj", "STL"),
        ("scene.glb", "a.ply", "glTF"),
        ("scene_normal.png", "b.obj", "is an image, not a model"),
        ("scene.mtl", "c.obj", "is a material library of an OBJ"),
        ("scene.usda", "d.obj", "is USD, which is not read here"),
        ("scene.usdz", "d.glb", "is USD, which is not read here"),
        ("", "e.obj", "is empty"),
        ("", "e.fbx", "is empty"),
        ("", "e.glb", "is empty"),
    ] {
        let path = folder.path().join(name);
        fs::write(&path, if content.is_empty() { Vec::new() } else { fs::read(blender(content)).unwrap() })
            .unwrap();
        let found = match Document::open(&path, &LoadOptions::default()) {
            Ok(document) => {
                document.provenance().map_or("glTF", |provenance| provenance.format.name()).to_owned()
            }
            Err(error) => error.to_string(),
        };
        assert!(found.contains(words), "{content} as {name}: {found}");
    }
}

#[test]
fn textures_with_paths_of_windows_are_found_by_name() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("a.obj"),
        "mtllib C:\\work\\a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n",
    )
    .unwrap();
    fs::write(
        folder.path().join("a.mtl"),
        "newmtl a\nnorm -bm 0.5 D:\\maps\\a map.png\nmap_Kd ../outside.png\n",
    )
    .unwrap();
    fs::copy(blender("scene_normal.png"), folder.path().join("a map.png")).unwrap();
    let document = open(&folder.path().join("a.obj"));
    assert_eq!(document.json()["materials"][0]["normalTexture"]["scale"], 0.5);
    let warnings = document.warnings();
    assert_eq!(warnings.len(), 3, "{warnings:?}");
    assert!(warnings.iter().filter(|warning| warning.contains("by its name")).count() == 2, "{warnings:?}");
    assert!(
        warnings.iter().any(|warning| warning.contains("\"../outside.png\" is not in the model's folder"))
    );
}

/// Windows does not tell cases apart, so files that were made there may not either.
#[test]
#[cfg(target_os = "linux")]
fn textures_in_other_letters_case_are_found() {
    let [outside, folder] = [(), ()].map(|()| tempfile::tempdir().unwrap());
    fs::create_dir(folder.path().join("textures")).unwrap();
    std::os::unix::fs::symlink(outside.path(), folder.path().join("linked")).unwrap();
    fs::write(folder.path().join("a.obj"), "mtllib A.MTL\nv 0 0 0\nvt 0 0\nusemtl a\nf 1/1 1/1 1/1\n")
        .unwrap();
    let library = "newmtl a\nnorm Textures\\Scene_Normal.PNG\nmap_Kd Linked/Secret.png\n";
    fs::write(folder.path().join("a.mtl"), library).unwrap();
    fs::copy(blender("scene_normal.png"), folder.path().join("textures/scene_normal.png")).unwrap();
    fs::copy(blender("scene_normal.png"), outside.path().join("secret.png")).unwrap();
    let document = open(&folder.path().join("a.obj"));
    let warnings = [
        "\"A.MTL\" was found as a.mtl, by its name",
        "\"Textures\\Scene_Normal.PNG\" was found as textures/scene_normal.png, by its name",
        "a.mtl: \"Linked/Secret.png\" is not in the model's folder; the texture is left out",
    ];
    let mut found = document.warnings().to_vec();
    found.sort_unstable();
    assert_eq!(found, warnings);
    assert_eq!(document.json()["images"].as_array().unwrap().len(), 1);
}

/// A path that differs in its letters' case is nearer than a name elsewhere, and a name that is written so
/// nearer than one in another case.
#[test]
#[cfg(target_os = "linux")]
fn the_nearest_texture_is_found() {
    let found = |reference: &str, files: &[&str]| {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("textures")).unwrap();
        for (number, file) in files.iter().enumerate() {
            // Different images.
            let image = [fs::read(blender("scene_normal.png")).unwrap(), vec![0; number]].concat();
            fs::write(folder.path().join(file), image).unwrap();
        }
        fs::write(folder.path().join("a.obj"), "mtllib a.mtl\nv 0 0 0\nusemtl a\nf 1 1 1\n").unwrap();
        fs::write(folder.path().join("a.mtl"), format!("newmtl a\nmap_Kd {reference}\n")).unwrap();
        open(&folder.path().join("a.obj")).json()["images"][0]["name"].as_str().unwrap().to_owned()
    };
    let [lower, upper] = ["textures/wood.png", "textures/Wood.png"];
    assert_eq!(found("Textures/wood.png", &[lower, upper]), lower);
    assert_eq!(found("Textures/Wood.png", &[lower, upper]), upper);
    assert_eq!(found("Textures/WOOD.png", &[lower, upper]), upper);
    assert_eq!(found("Textures/Wood.png", &["Wood.png", lower]), lower);
    assert_eq!(found("C:\\textures\\Wood.png", &["Wood.png", lower]), "Wood.png");
    assert_eq!(found("maps/WOOD.png", &["Wood.png", lower]), "Wood.png");
}

/// The rules cut the same faces into other triangles, all of which cover them.
#[test]
fn polygons_are_cut_by_the_rule_that_is_asked_for() {
    // An L with six corners.
    let obj = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n";
    for rule in [PolygonRule::Blender, PolygonRule::Fan, PolygonRule::Ears] {
        let options = LoadOptions::default().with_polygon_rule(rule);
        let document = Document::from_bytes("model", obj.into(), None, &options).unwrap();
        let corners = document.corners().unwrap();
        let positions = corners[0].vectors::<3>("POSITION").unwrap().unwrap();
        let area = |t: &[[f32; 3]; 3]| {
            let [a, b, c] = *t;
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        };
        let areas: Vec<f32> = positions.as_chunks::<3>().0.iter().map(area).collect();
        assert!(areas.len() == 4 && areas.iter().all(|&area| area > 0.0), "{rule:?}: {areas:?}");
        assert_eq!(areas.iter().sum::<f32>(), 3.0, "{rule:?}");
        assert_eq!(document.provenance().unwrap().faces.polygons, 1);
    }
}

#[test]
fn other_formats_are_not_written_in_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ply");
    fs::write(&path, square("ascii")).unwrap();
    let document = open(&path);
    assert!(
        document.save_in_place().unwrap_err().to_string().contains("is PLY, which cannot be edited in place")
    );
    document.save(&folder.path().join("a.gltf"), &SaveOptions::default()).unwrap();
    assert!(open(&folder.path().join("a.gltf")).provenance().is_none());
}

/// 120 faces of up to 40 corners, most of them concave, have the triangles that Blender made.
#[test]
fn polygons_are_cut_as_blender_cuts_them() {
    let document = open(&blender("polygons.obj"));
    let found = document.corners().unwrap()[0].vertices().to_vec();
    let expected = fs::read_to_string(blender("polygons.txt")).unwrap();
    let (mut first, mut at, mut different) = (0, 0, Vec::new());
    for (face, line) in expected.lines().enumerate() {
        let expected: Vec<u32> =
            line.split(' ').map(|corner| first + corner.parse::<u32>().unwrap()).collect();
        if found[at..at + expected.len()] != expected {
            different.push(face);
        }
        (first, at) = (first + expected.len() as u32 / 3 + 2, at + expected.len());
    }
    assert_eq!(at, found.len());
    assert_eq!(different, [0; 0]);
}

/// Editors of Windows begin a text with a byte order mark.
#[test]
fn byte_order_marks_are_no_part_of_a_text() {
    let ascii = square("ascii");
    let marked = [b"\xEF\xBB\xBF", &ascii[..]].concat();
    assert!(read(marked).to_glb().unwrap() == read(ascii).to_glb().unwrap());
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    let marked = read(format!("\u{FEFF}{stl}"));
    assert_eq!(marked.json()["meshes"][0]["name"], "a");
    assert!(marked.to_glb().unwrap() == read(stl).to_glb().unwrap());
}

/// An ASCII PLY of a triangle: the properties of a vertex and of a face, and their numbers after `x y z` and
/// the indices.
fn triangle_ply(
    comments: &str,
    vertex: &[&str],
    vertices: [&str; 3],
    face: &[&str],
    numbers: &str,
) -> String {
    let lines = |names: &[&str]| names.iter().map(|name| format!("property {name}\n")).collect::<String>();
    let [a, b, c] = vertices;
    format!(
        "ply\nformat ascii 1.0\n{comments}element vertex 3\n{}{}element face 1\n{}{}end_header\n0 0 0 {a}\n1 0 0 {b}\n0 1 0 {c}\n3 0 1 2 {numbers}\n",
        lines(&["float x", "float y", "float z"]),
        lines(vertex),
        lines(&["list uchar int vertex_indices"]),
        lines(face),
    )
}

#[test]
fn uvs_of_ply_are_read_under_all_names() {
    for [u, v] in [
        ["s", "t"],
        ["u", "v"],
        ["texture_u", "texture_v"],
        ["texcoord_u", "texcoord_v"],
        ["tu", "tv"],
        ["tx", "ty"],
    ] {
        let properties = [format!("float {u}"), format!("float {v}")];
        let properties = properties.each_ref().map(|property| &**property);
        let document = read(triangle_ply("", &properties, ["0 0", "1 0", "0 0.75"], &[], ""));
        assert_eq!(document.warnings(), [""; 0]);
        let uvs = document.corners().unwrap()[0].vectors::<2>("TEXCOORD_0").unwrap();
        assert_eq!(uvs, Some(vec![[0.0, 1.0], [1.0, 1.0], [0.0, 0.25]]), "{u} {v}");
    }
    // Two pairs are two sets.
    let document = read(triangle_ply(
        "",
        &["float s", "float t", "float s1", "float t1"],
        ["0 0 2 0", "1 0 2 0", "0 1 2 1"],
        &[],
        "",
    ));
    let sets = ["TEXCOORD_0", "TEXCOORD_1"]
        .map(|set| document.corners().unwrap()[0].vectors::<2>(set).unwrap().unwrap()[2]);
    assert_eq!(sets, [[0.0, 0.0], [2.0, 0.0]]);
    assert_eq!(document.json()["meshes"][0]["extras"]["uvSetNames"], ["s t", "s1 t1"]);
}

/// MeshLab writes the UVs of corners, and the number of a texture for each face.
#[test]
fn uvs_and_textures_of_faces_are_read() {
    let folder = tempfile::tempdir().unwrap();
    fs::copy(blender("scene_normal.png"), folder.path().join("b.png")).unwrap();
    let comments = "comment TextureFile a.png\ncomment TextureFile b.png\n";
    let header = |faces: &str| {
        format!(
            "ply\nformat ascii 1.0\n{comments}element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n{faces}end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
        )
    };
    let [indices, uvs, number] =
        ["list uchar int vertex_indices", "list uchar float texcoord", "int texnumber"]
            .map(|property| format!("property {property}\n"));
    let orders = [
        (header(&[&*indices, &uvs, &number].concat()), "3 0 1 2 6 0 0 1 0 1 1 1\n3 0 2 3 6 0 0 1 1 0 1 0\n"),
        (header(&[&*uvs, &number, &indices].concat()), "6 0 0 1 0 1 1 1 3 0 1 2\n6 0 0 1 1 0 1 0 3 0 2 3\n"),
    ];
    for (header, faces) in orders {
        fs::write(folder.path().join("a.ply"), format!("{header}{faces}")).unwrap();
        let document = open(&folder.path().join("a.ply"));
        let warnings = document.warnings();
        assert!(warnings.len() == 1 && warnings[0].contains("\"a.png\" is not in"), "{warnings:?}");
        let json = document.json();
        assert_eq!(json["materials"].as_array().unwrap().len(), 2);
        assert!(json["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"].is_object());
        let primitives = json["meshes"][0]["primitives"].as_array().unwrap();
        assert_eq!([0, 1].map(|i| primitives[i]["material"].as_u64().unwrap()), [1, 0]);
        let corners = document.corners().unwrap();
        let uvs = [0, 1].map(|i| corners[i].vectors::<2>("TEXCOORD_0").unwrap().unwrap()[2]);
        assert_eq!(uvs, [[1.0, 0.0], [0.0, 0.0]]);
    }
    // A face without UVs is a warning, and the others keep theirs.
    let header = header(&[&*indices, &uvs, &number].concat());
    let document = read(format!("{header}3 0 1 2 6 0 0 1 0 1 1 1\n3 0 2 3 0 -1\n"));
    let corners = document.corners().unwrap();
    assert_eq!([0, 1].map(|i| corners[i].vectors::<2>("TEXCOORD_0").unwrap().is_some()), [true, false]);
}

/// What a PLY has and glTF does not is listed.
#[test]
fn properties_of_ply_that_are_lost_are_listed() {
    let not_carried = |ply: String| read(ply).provenance().unwrap().not_carried.clone();
    let ply =
        triangle_ply("", &["float nx", "float ny", "float quality"], ["0 0 1"; 3], &["uchar red"], "255");
    assert_eq!(not_carried(ply), ["the vertex properties nx, ny, quality", "the face property red"]);
    let ply = triangle_ply(
        "",
        &["float s", "float t"],
        ["0 0", "1 0", "0 1"],
        &["list uchar float texcoord"],
        "6 0 0 1 0 1 1",
    );
    assert_eq!(not_carried(ply), ["the UVs of vertices, which those of the faces replace"]);
    let ply = triangle_ply("comment TextureFile a.png\ncomment TextureFile b.png\n", &[], [""; 3], &[], "");
    assert_eq!(not_carried(ply), ["1 texture after the first, which no face names"]);
    let ply = triangle_ply("", &["uchar red", "uchar green"], ["1 2"; 3], &[], "");
    assert_eq!(not_carried(ply), ["the vertex properties red, green"]);
    let with_edges = triangle_ply("", &[], [""; 3], &[], "")
        .replace("end_header", "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header")
        + "0 1\n";
    assert_eq!(not_carried(with_edges), ["1 edge, an element that is not read"]);
}

#[test]
fn colours_of_vertices_are_linear() {
    let ply = triangle_ply("", &["uchar r", "uchar g", "uchar b", "uchar a"], ["0 255 188 51"; 3], &[], "");
    let document = read(ply);
    assert_eq!(document.warnings(), [""; 0]);
    let [r, g, b, a] = document.corners().unwrap()[0].vectors::<4>("COLOR_0").unwrap().unwrap()[0];
    assert!(r == 0.0 && g == 1.0 && (b - 0.5029).abs() < 1e-3 && (a - 0.2).abs() < 1e-6, "{r} {g} {b} {a}");
}

/// A binary STL of two triangles with the same winding.
fn binary_stl(header: &[u8], normals: [[f32; 3]; 2], attributes: [u16; 2]) -> Vec<u8> {
    let mut stl = header.to_vec();
    stl.resize(80, 0);
    stl.extend(2u32.to_le_bytes());
    for (normal, attribute) in normals.into_iter().zip(attributes) {
        let numbers = [&normal[..], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]].concat();
        stl.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        stl.extend(attribute.to_le_bytes());
    }
    stl
}

/// Normals and colours of facets are not carried over, and it is said where they hold anything.
#[test]
fn normals_and_colours_of_facets_are_listed() {
    let up = [0.0, 0.0, 1.0];
    let slanted = [0.6, 0.0, 0.8];
    let against = "1 facet's normal points against the winding, which decides; if the model looks inside out, turn its faces over";
    let not_carried = |stl: Vec<u8>| {
        let document = read(stl);
        let provenance = document.provenance().unwrap().not_carried.clone();
        let others = document.warnings().iter().filter(|warning| !warning.starts_with("not carried over"));
        (provenance, others.cloned().collect::<Vec<_>>())
    };
    let none = (Vec::<String>::new(), Vec::<String>::new());
    assert_eq!(not_carried(binary_stl(b"a", [up, [0.0; 3]], [0; 2])), none);
    let (lost, _) = not_carried(binary_stl(b"a", [up, slanted], [0; 2]));
    assert_eq!(lost, ["the normals of 1 facet, which are not those of the winding"]);
    assert_eq!(not_carried(binary_stl(b"a", [up, [0.0, 0.0, -2.0]], [0; 2])).1, [against]);
    let (lost, _) = not_carried(binary_stl(b"a", [up; 2], [0x8123, 0]));
    assert_eq!(lost, ["the attributes of 1 facet, such as colours"]);
    let (lost, _) = not_carried(binary_stl(b"COLOR=\x80\x80\x80\xFF", [up; 2], [0; 2]));
    assert_eq!(lost, ["the colour of all facets in the header"]);
    let ascii = "solid a\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    assert_eq!(not_carried(ascii.into()).1, [against]);
}

/// The program of a PLY is found as that of an OBJ is.
#[test]
fn comments_of_a_ply_name_its_program() {
    let program = |comment: &str| {
        let text = String::from_utf8(square("ascii")).unwrap();
        let ply = text.replacen("element vertex", &format!("comment {comment}\nelement vertex"), 1);
        read(ply).provenance().unwrap().generator.clone()
    };
    assert_eq!(program("rhino head"), None);
    assert_eq!(program("VCGLIB generated").as_deref(), Some("VCGLIB generated"));
    assert_eq!(program("File exported by Rhinoceros").as_deref(), Some("Rhinoceros"));
}

/// A model without triangles would be a glTF with empty lists, which are invalid.
#[test]
fn a_ply_of_edges_has_no_faces() {
    let edge = String::from_utf8(square("ascii")).unwrap().replace("4 0 1 2 3", "2 0 1");
    assert!(refusal(edge).contains("is a PLY without faces"));
}

#[test]
fn faces_of_few_corners_are_listed() {
    let header = String::from_utf8(square("ascii")).unwrap().replace("element face 1", "element face 4");
    let document = read(header + "2 0 1\n1 0\n0\n");
    assert_eq!(document.warnings(), ["not carried over: 2 faces of one or two corners"]);
}

#[test]
fn models_with_other_meshes_are_not_compared() {
    let square = || String::from_utf8(square("ascii")).unwrap();
    let solids = |names: &[&str]| {
        let face =
            "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n";
        names.iter().map(|name| format!("solid {name}\n{face}endsolid {name}\n")).collect::<String>()
    };
    let [one, two] = [square(), solids(&["a", "b"])].map(read);
    let problem = darboux_io::gltf::pair_tangents(&one, &two).unwrap_err().to_string();
    assert!(
        problem.contains("meshes: has 2 meshes, but model has 1; compare files of one model"),
        "{problem}"
    );
    assert!(darboux_io::gltf::pair_tangents(&one, &one).is_ok());
}

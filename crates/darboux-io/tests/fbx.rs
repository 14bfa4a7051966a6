//! FBX: Blender's beside its glTF of the same scene, an ASCII file, damaged files.
#![cfg(feature = "fbx")]

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents};
use darboux_io::{LoadOptions, MemoryLimit};

fn asset(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/blender").join(name)
}

fn open(name: &str) -> Document {
    Document::open(&asset(name), &LoadOptions::default()).unwrap()
}

fn from_bytes(bytes: &[u8], options: &LoadOptions) -> Result<Document, String> {
    Document::from_bytes("model.fbx", bytes.to_vec(), None, options).map_err(|error| error.to_string())
}

#[test]
fn hierarchy_skin_shapes_and_material_are_kept() {
    let document = open("scene.fbx");
    let json = document.json();
    let list = |name: &str| json[name].as_array().unwrap();
    let names: Vec<&str> = list("nodes").iter().map(|node| node["name"].as_str().unwrap()).collect();
    for name in ["Armature", "Block", "Block mirrored", "Body", "Left", "Right"] {
        assert!(names.contains(&name), "{names:?}");
    }
    let node = |name: &str| &list("nodes")[names.iter().position(|found| *found == name).unwrap()];
    assert_eq!(list("meshes").len(), 2, "instances share a mesh");
    assert_eq!(node("Block")["mesh"], node("Block mirrored")["mesh"]);
    let sheet = &list("meshes")[node("Body")["mesh"].as_u64().unwrap() as usize];
    assert_eq!(sheet["extras"]["targetNames"], ["Bulge", "Shear"]);
    let attributes = sheet["primitives"][0]["attributes"].as_object().unwrap();
    for name in ["POSITION", "NORMAL", "TEXCOORD_0", "TEXCOORD_1", "JOINTS_0", "WEIGHTS_0"] {
        assert!(attributes.contains_key(name), "{attributes:?}");
    }
    let skin = &list("skins")[node("Body")["skin"].as_u64().unwrap() as usize];
    let joints: Vec<&str> = skin["joints"]
        .as_array()
        .unwrap()
        .iter()
        .map(|joint| names[joint.as_u64().unwrap() as usize])
        .collect();
    assert_eq!(joints, ["Left", "Right"]);
    let material = &list("materials")[0];
    assert_eq!(material["name"], "Scales");
    let shading = &material["pbrMetallicRoughness"];
    assert_eq!(shading["baseColorFactor"], [0.25, 0.5, 0.75, 1.0]);
    assert_eq!(shading["metallicFactor"], 0.25);
    assert_eq!(shading["roughnessFactor"], 0.75);
    assert!(material["normalTexture"].is_object());
    assert_eq!(document.warnings(), &[] as &[String]);
}

/// Position, normal and UV.
type Key = [u32; 8];

/// The tangents of the vertices of a mesh by the bits of their other attributes. Several, where UVs are
/// mirrored.
fn tangents(document: &mut Document, mesh: &str) -> HashMap<Key, Vec<[u32; 4]>> {
    add_tangents(document, &AddTangentsOptions::default(), &mut |_| {}).unwrap();
    let json = document.json();
    let mesh = json["meshes"].as_array().unwrap().iter().find(|found| found["name"] == mesh).unwrap();
    let attributes = &mesh["primitives"][0]["attributes"];
    let accessor = |name: &str| attributes[name].as_u64().unwrap() as usize;
    let positions = document.vectors::<3>(accessor("POSITION")).unwrap();
    let normals = document.vectors::<3>(accessor("NORMAL")).unwrap();
    let uvs = document.vectors::<2>(accessor("TEXCOORD_0")).unwrap();
    let tangents = document.vectors::<4>(accessor("TANGENT")).unwrap();
    let mut found: HashMap<Key, Vec<[u32; 4]>> = HashMap::new();
    for (((p, n), uv), tangent) in positions.iter().zip(normals.iter()).zip(uvs.iter()).zip(tangents.iter()) {
        // -0 and 0 are the same number.
        let key = [p[0], p[1], p[2], n[0], n[1], n[2], uv[0], uv[1]].map(|x| (x + 0.0).to_bits());
        found.entry(key).or_default().push(tangent.map(|x| (x + 0.0).to_bits()));
    }
    found.values_mut().for_each(|tangents| tangents.sort_unstable());
    found
}

#[test]
fn tangents_have_the_bits_of_the_gltf() {
    let (mut gltf, mut fbx) = (open("scene.z-up.glb"), open("scene.fbx"));
    for (name, vertices) in [("Sheet", 54), ("Block", 20)] {
        let (of_gltf, of_fbx) = (tangents(&mut gltf, name), tangents(&mut fbx, name));
        assert_eq!((of_gltf.len(), of_fbx.len()), (vertices, vertices));
        let different = of_gltf.iter().filter(|(key, tangents)| of_fbx.get(*key) != Some(tangents)).count();
        assert_eq!(different, 0, "{name}");
    }
}

/// A quad and a concave pentagon, two materials, normals by smoothing group, a normal map under a path of
/// another machine; z up, in inches.
const ASCII: &str = r#"; FBX 7.3.0 project file
FBXHeaderExtension:  {
    FBXHeaderVersion: 1003
    FBXVersion: 7300
    Creator: "By hand"
}
GlobalSettings:  {
    Version: 1000
    Properties70:  {
        P: "UpAxis", "int", "Integer", "",2
        P: "UpAxisSign", "int", "Integer", "",1
        P: "FrontAxis", "int", "Integer", "",1
        P: "FrontAxisSign", "int", "Integer", "",-1
        P: "CoordAxis", "int", "Integer", "",0
        P: "CoordAxisSign", "int", "Integer", "",1
        P: "UnitScaleFactor", "double", "Number", "",2.54
    }
}
Objects:  {
    Geometry: 1, "Geometry::Plate", "Mesh" {
        Vertices: *24 {
            a: 0,0,0, 1,0,0, 1,1,0, 0,1,0, 2,0,0, 3,0,0, 2,0.25,0, 3,1,0
        }
        PolygonVertexIndex: *9 {
            a: 0,1,2,-4, 1,5,6,7,-3
        }
        GeometryVersion: 124
        LayerElementUV: 0 {
            Version: 101
            Name: "map1"
            MappingInformationType: "ByPolygonVertex"
            ReferenceInformationType: "IndexToDirect"
            UV: *16 {
                a: 0,0, 1,0, 1,1, 0,1, 2,0, 3,0, 2,0.25, 3,1
            }
            UVIndex: *9 {
                a: 0,1,2,3,1,5,6,7,2
            }
        }
        LayerElementSmoothing: 0 {
            Version: 102
            Name: ""
            MappingInformationType: "ByPolygon"
            ReferenceInformationType: "Direct"
            Smoothing: *2 {
                a: 1,1
            }
        }
        LayerElementMaterial: 0 {
            Version: 101
            Name: ""
            MappingInformationType: "ByPolygon"
            ReferenceInformationType: "IndexToDirect"
            Materials: *2 {
                a: 0,1
            }
        }
        Layer: 0 {
            Version: 100
            LayerElement:  {
                Type: "LayerElementUV"
                TypedIndex: 0
            }
            LayerElement:  {
                Type: "LayerElementSmoothing"
                TypedIndex: 0
            }
            LayerElement:  {
                Type: "LayerElementMaterial"
                TypedIndex: 0
            }
        }
    }
    Model: 2, "Model::Group", "Null" {
        Version: 232
    }
    Model: 3, "Model::Plate", "Mesh" {
        Version: 232
        Properties70:  {
            P: "Lcl Translation", "Lcl Translation", "", "A",10,0,0
            P: "GeometricTranslation", "Vector3D", "Vector", "",0,0,1
        }
    }
    Material: 4, "Material::First", "" {
        ShadingModel: "lambert"
        Properties70:  {
            P: "DiffuseColor", "Color", "", "A",0.5,0.25,1
        }
    }
    Material: 5, "Material::Second", "" {
        ShadingModel: "phong"
    }
    Texture: 6, "Texture::Bumps", "" {
        Type: "TextureVideoClip"
        TextureName: "Texture::Bumps"
        FileName: "C:\work\maps\scene_normal.png"
        RelativeFilename: "..\..\maps\scene_normal.png"
    }
}
Connections:  {
    C: "OO",2,0
    C: "OO",3,2
    C: "OO",1,3
    C: "OO",4,3
    C: "OO",5,3
    C: "OP",6,4, "NormalMap"
}
"#;

#[test]
fn ascii_with_polygons_smoothing_units_and_paths_of_windows() {
    let folder = std::env::temp_dir().join(format!("darboux-fbx-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::copy(asset("scene_normal.png"), folder.join("scene_normal.png")).unwrap();
    std::fs::write(folder.join("hand.fbx"), ASCII).unwrap();
    let document = Document::open(&folder.join("hand.fbx"), &LoadOptions::default());
    std::fs::remove_dir_all(&folder).unwrap();
    let document = document.unwrap();
    let json = document.json();
    assert_eq!(document.provenance().unwrap().primitive(0, 0).unwrap().path, "Group/Plate");
    let primitives = json["meshes"][0]["primitives"].as_array().unwrap();
    let triangles = primitives.iter().map(|primitive| {
        let accessor = primitive["indices"].as_u64().unwrap() as usize;
        json["accessors"][accessor]["count"].as_u64().unwrap() / 3
    });
    assert_eq!(triangles.collect::<Vec<_>>(), [2, 3]);
    assert_eq!(primitives[0]["material"], 0);
    assert_eq!(primitives[1]["material"], 1);
    assert!(primitives[0]["attributes"].get("NORMAL").is_some());
    assert!(json["materials"][0]["normalTexture"].is_object());
    let warnings = document.warnings().join("\n");
    for part in [
        "1 mesh has no normals; they were made by its smoothing groups",
        "whether green points up or down in the normal map of material \"First\"",
        "scene_normal.png, by its name",
    ] {
        assert!(warnings.contains(part), "{warnings}");
    }
    // A unit of 2.54 cm, and z up.
    let scene = document.mesh_instances().unwrap();
    let [x, y, z] = [0, 1, 2].map(|i| scene.meshes[0].matrices[0][i].map(|x| (x * 1e4).round() / 1e4));
    assert_eq!((x, y, z), ([0.0254, 0.0, 0.0, 0.0], [0.0, 0.0, -0.0254, 0.0], [0.0, 0.0254, 0.0, 0.0]));
    assert_eq!(scene.meshes[0].matrices[0][3].map(|x| (x * 1e4).round() / 1e4), [0.254, 0.0254, 0.0, 1.0]);
}

/// Textures stay in a folder beside the FBX, while the paths are those of another machine.
#[test]
fn textures_are_found_in_the_folders_beside_an_fbx() {
    for place in ["maps", "textures", "hand.fbm"] {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join(place)).unwrap();
        let image = format!("{place}/scene_normal.png");
        std::fs::copy(asset("scene_normal.png"), folder.path().join(&image)).unwrap();
        std::fs::write(folder.path().join("hand.fbx"), ASCII).unwrap();
        let document = Document::open(&folder.path().join("hand.fbx"), &LoadOptions::default()).unwrap();
        assert_eq!(document.json()["images"].as_array().map(Vec::len), Some(1), "{place}");
        let warning = format!(r#""..\..\maps\scene_normal.png" was found as {image}, by its name"#);
        assert!(document.warnings().contains(&warning), "{:?}", document.warnings());
    }
}

#[test]
fn damaged_files_are_errors_or_warnings() {
    let bytes = std::fs::read(asset("scene.fbx")).unwrap();
    let half = from_bytes(&bytes[..bytes.len() / 2], &LoadOptions::default());
    let cut_off = "model.fbx: is cut off; copy or export it again";
    assert_eq!(half.unwrap_err(), cut_off);
    // At every size, in arrays of compressed numbers as well, up to the zeros that end the list of nodes.
    for length in (27..bytes.len() - 300).step_by(301).chain([30_000, 27 + 12]) {
        let cut = from_bytes(&bytes[..length], &LoadOptions::default());
        assert_eq!(cut.unwrap_err(), cut_off, "{length} bytes");
    }
    // An ASCII file that ends in a block, in a string or in an array.
    for part in ["GeometryVersion: 124\n", "\"Model::Gro", "a: 0,0,0, 1,0,0, 1"] {
        let start = &ASCII[..ASCII.find(part).unwrap() + part.len()];
        assert_eq!(from_bytes(start.as_bytes(), &LoadOptions::default()).unwrap_err(), cut_off, "{part}");
    }
    // A header that is damaged is another fault.
    let mut damaged = bytes.clone();
    damaged[20] = b' ';
    let error = from_bytes(&damaged, &LoadOptions::default()).err();
    assert_ne!(error.as_deref(), Some(cut_off));
    let mut damaged = bytes.clone();
    damaged[2000..2100].fill(255);
    let error = from_bytes(&damaged, &LoadOptions::default()).unwrap_err();
    assert!(error.starts_with("model.fbx: is not a valid FBX ("), "{error}");
    // Braces in comments and strings do not count.
    let braces =
        ASCII.replacen('\n', "\n; a comment with { and \"\n", 1).replace("Model::Plate", "Model::Plate{");
    from_bytes(braces.as_bytes(), &LoadOptions::default()).unwrap();
    let options = LoadOptions::default().with_memory_limit(MemoryLimit::bytes(100_000));
    let error = from_bytes(&bytes, &options).unwrap_err();
    assert!(
        error.starts_with("model.fbx: the scene needs more than the memory limit of 1 MiB; if"),
        "{error}"
    );
    let empty = from_bytes(b"; FBX 7.3.0 project file\n", &LoadOptions::default()).unwrap_err();
    assert!(empty.starts_with("model.fbx: "), "{empty}");
    let mut refused = 0;
    for place in (30..bytes.len()).step_by(97) {
        let mut damaged = bytes.clone();
        damaged[place] ^= 0x55;
        refused += usize::from(from_bytes(&damaged, &LoadOptions::default()).is_err());
    }
    assert!(refused > 10, "{refused}");
}

//! FBX of all versions: Blender's file of 7400 with the numbers and records of others, and a text of 6100.
#![cfg(feature = "fbx")]

use std::path::Path;

use darboux_io::LoadOptions;
use darboux_io::gltf::Document;

const SCENE: &[u8] = include_bytes!("../../../assets/blender/scene.fbx");

/// The length of a binary header, whose last four bytes are the version.
const HEADER: usize = 27;

fn open(bytes: Vec<u8>) -> Document {
    let folder = Path::new("../../assets/blender");
    let document = Document::from_bytes("scene.fbx", bytes, Some(folder), &LoadOptions::default());
    document.unwrap_or_else(|error| panic!("{error}"))
}

fn number(bytes: &[u8]) -> usize {
    u32::from_le_bytes(*bytes.first_chunk().unwrap()) as usize
}

/// Copies the records from `at` on to `end`, with 64 bits for the three numbers at the start of each, as
/// versions from 7500 on have them.
fn widen(from: &[u8], mut at: usize, end: usize, to: &mut Vec<u8>) -> usize {
    while at < end {
        let [record_end, properties, length] = [0, 4, 8].map(|offset| number(&from[at + offset..]));
        if record_end == 0 {
            to.extend([0; 25]);
            return at + 13;
        }
        let start = to.len();
        let name_end = at + 13 + usize::from(from[at + 12]);
        to.extend([0; 8]);
        to.extend((properties as u64).to_le_bytes());
        to.extend((length as u64).to_le_bytes());
        to.extend(&from[at + 12..name_end + length]);
        widen(from, name_end + length, record_end, to);
        let record = (to.len() as u64).to_le_bytes();
        to[start..start + 8].copy_from_slice(&record);
        at = record_end;
    }
    at
}

#[test]
fn binary_files_of_all_versions_are_one_model() {
    let expected = open(SCENE.to_vec());
    assert_eq!(number(&SCENE[23..]), 7400);
    let expected = expected.to_glb().unwrap();
    for version in [7100u32, 7200, 7300, 7500, 7700] {
        let mut file = SCENE[..HEADER].to_vec();
        file[23..].copy_from_slice(&version.to_le_bytes());
        if version < 7500 {
            file.extend(&SCENE[HEADER..]);
        } else {
            let footer = widen(SCENE, HEADER, SCENE.len(), &mut file);
            file.extend(&SCENE[footer..]);
        }
        let document = open(file);
        assert_eq!(document.warnings(), [""; 0], "{version}");
        assert!(document.to_glb().unwrap() == expected, "{version}");
    }
    let mut newer = SCENE.to_vec();
    newer[23..HEADER].copy_from_slice(&7300u32.to_le_bytes());
    newer[24] = 0x27; // 10,116
    let sentence = Document::from_bytes("scene.fbx", newer, None, &LoadOptions::default())
        .map_or_else(|error| error.to_string(), |document| document.warnings().join("\n"));
    assert!(sentence.starts_with("scene.fbx: ") || sentence.contains("has FBX version 10116"), "{sentence}");
}

/// Before 7000, geometry stands within its node, and connections go by name.
const OLD: &str = r#"; FBX 6.1.0 project file
FBXHeaderExtension:  {
    FBXHeaderVersion: 1003
    FBXVersion: 6100
    Creator: "By hand"
}
Objects:  {
    Model: "Model::Plate", "Mesh" {
        Version: 232
        Properties60:  {
            Property: "Lcl Translation", "Lcl Translation", "A+",1,2,3
            Property: "Lcl Scaling", "Lcl Scaling", "A+",-1,1,1
        }
        Vertices: 0,0,0,1,0,0,1,1,0,0,1,0
        PolygonVertexIndex: 0,1,2,-4
        GeometryVersion: 124
        LayerElementNormal: 0 {
            Version: 101
            Name: ""
            MappingInformationType: "ByPolygon"
            ReferenceInformationType: "Direct"
            Normals: 0,0,1
        }
        LayerElementUV: 0 {
            Version: 101
            Name: "map1"
            MappingInformationType: "ByPolygonVertex"
            ReferenceInformationType: "IndexToDirect"
            UV: 0,0,1,0,1,1,0,0.75
            UVIndex: 0,1,2,3
        }
        LayerElementMaterial: 0 {
            Version: 101
            Name: ""
            MappingInformationType: "AllSame"
            ReferenceInformationType: "IndexToDirect"
            Materials: 0
        }
        Layer: 0 {
            Version: 100
            LayerElement:  {
                Type: "LayerElementNormal"
                TypedIndex: 0
            }
            LayerElement:  {
                Type: "LayerElementUV"
                TypedIndex: 0
            }
            LayerElement:  {
                Type: "LayerElementMaterial"
                TypedIndex: 0
            }
        }
    }
    Material: "Material::Paint", "" {
        Version: 102
        ShadingModel: "phong"
        MultiLayer: 0
        Properties60:  {
            Property: "DiffuseColor", "ColorRGB", "",0.5,0.25,1
        }
    }
}
Connections:  {
    Connect: "OO", "Model::Plate", "Model::Scene"
    Connect: "OO", "Material::Paint", "Model::Plate"
}
"#;

#[test]
fn texts_of_version_6100_are_read() {
    let document = open(OLD.into());
    assert_eq!(document.warnings(), [""; 0]);
    assert_eq!(document.provenance().unwrap().faces.quads, 1);
    let corners = &document.corners().unwrap()[0];
    assert!(corners.vectors::<3>("NORMAL").unwrap().unwrap().iter().all(|n| *n == [0.0, 0.0, 1.0]));
    assert!(corners.vectors::<2>("TEXCOORD_0").unwrap().unwrap().contains(&[0.0, 0.25]));
    assert_eq!(
        document.json()["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"],
        [0.5, 0.25, 1.0, 1.0]
    );
    let matrix = document.mesh_instances().unwrap().meshes[0].matrices[0];
    assert!(matrix[0][0] < 0.0 && matrix[1][1] > 0.0, "{matrix:?}");
}

//! How FBX places textures in the plane of UVs: numbers by hand, and Blender's beside its glTF.
#![cfg(feature = "fbx")]

use std::path::Path;

use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use darboux_io::json::Value;

/// An ASCII FBX of one triangle with a texture that has these properties.
fn fbx(properties: &str) -> String {
    format!(
        "; FBX 7.4.0 project file\nFBXHeaderExtension:  {{\nFBXHeaderVersion: 1003\nFBXVersion: 7400\nCreator: \"By hand\"\n}}\nObjects:  {{\n\
        Geometry: 1, \"Geometry::Plate\", \"Mesh\" {{\nVertices: *9 {{\na: 0,0,0,1,0,0,0,1,0\n}}\nPolygonVertexIndex: *3 {{\na: 0,1,-3\n}}\nGeometryVersion: 124\n}}\n\
        Model: 3, \"Model::Plate\", \"Mesh\" {{\nVersion: 232\n}}\n\
        Material: 4, \"Material::Paint\", \"\" {{\nShadingModel: \"phong\"\nProperties70:  {{\n}}\n}}\n\
        Texture: 12, \"Texture::paint\", \"\" {{\nType: \"TextureVideoClip\"\nFileName: \"paint.png\"\nRelativeFilename: \"paint.png\"\nProperties70:  {{\n{properties}}}\n}}\n\
        Video: 13, \"Video::paint\", \"Clip\" {{\nType: \"Clip\"\nFileName: \"paint.png\"\nRelativeFilename: \"paint.png\"\nContent: ,\n\"iVBORw0KGgo=\"\n}}\n}}\n\
        Connections:  {{\nC: \"OO\",3,0\nC: \"OO\",1,3\nC: \"OO\",4,3\nC: \"OP\",12,4, \"DiffuseColor\"\nC: \"OO\",13,12\n}}\n"
    )
}

fn open(properties: &str) -> Document {
    let document =
        Document::from_bytes("plate.fbx", fbx(properties).into_bytes(), None, &LoadOptions::default());
    document.unwrap_or_else(|error| panic!("{error}"))
}

fn vector(name: &str, [x, y, z]: [f32; 3]) -> String {
    format!("P: \"{name}\", \"Vector\", \"\", \"A\",{x},{y},{z}\n")
}

fn number(name: &str, value: i32) -> String {
    format!("P: \"{name}\", \"enum\", \"\", \"\",{value}\n")
}

/// Offset, rotation and scale of a texture; those of glTF where the extension is absent.
fn transform(texture: &Value) -> [f64; 5] {
    let found = &texture["extensions"]["KHR_texture_transform"];
    let pair = |name: &str, default: f64| [0, 1].map(|i| found[name][i].as_f64().unwrap_or(default));
    let ([x, y], [sx, sy]) = (pair("offset", 0.0), pair("scale", 1.0));
    [x, y, found["rotation"].as_f64().unwrap_or(0.0), sx, sy]
}

fn base_color(document: &Document) -> Value {
    document.json()["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].clone()
}

/// 3ds Max writes the tiling as the scaling, and 0.5 - (offset + 0.5) * tiling as the translation: the
/// texture repeats about its middle. In glTF, v points down.
#[test]
fn scaling_and_translation_become_the_transform_of_gltf() {
    for (translation, scaling, expected) in [
        ([0.0, 0.0, 0.0], [2.0, 4.0, 1.0], [0.0, -3.0, 0.0, 2.0, 4.0]),
        ([0.25, 0.125, 0.0], [1.0, 1.0, 1.0], [0.25, -0.125, 0.0, 1.0, 1.0]),
        // Tiling 2, offset 0.25: u = 2 * (u - 0.75) + 0.5.
        ([-1.0, -1.0, 0.0], [2.0, 2.0, 1.0], [-1.0, 0.0, 0.0, 2.0, 2.0]),
        ([0.0, 0.0, 0.0], [-1.0, 1.0, 1.0], [0.0, 0.0, 0.0, -1.0, 1.0]),
        // What is about the third axis means nothing.
        ([0.0, 0.0, 7.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0, 1.0]),
    ] {
        let document = open(&(vector("Translation", translation) + &vector("Scaling", scaling)));
        let texture = base_color(&document);
        assert_eq!(transform(&texture), expected);
        let is_plain = expected == [0.0, 0.0, 0.0, 1.0, 1.0];
        assert_eq!(texture.get("extensions").is_none(), is_plain, "{texture:?}");
        assert_eq!(document.json().get("extensionsUsed").is_none(), is_plain);
        assert_eq!(document.provenance().unwrap().not_carried, [""; 0]);
    }
}

/// Programs read rotations, centres and swapped axes differently.
#[test]
fn what_programs_read_differently_is_listed() {
    let scaling = vector("Scaling", [2.0, 2.0, 1.0]);
    for properties in [
        vector("Rotation", [0.0, 0.0, 30.0]),
        scaling + &vector("TextureScalingPivot", [0.5, 0.5, 0.0]),
        number("UVSwap", 1),
    ] {
        let document = open(&properties);
        assert!(base_color(&document).get("extensions").is_none(), "{properties}");
        assert_eq!(
            document.provenance().unwrap().not_carried,
            ["the scale, rotation or offset of paint.png"],
            "{properties}"
        );
    }
}

/// Blender up to 2.79 had no nodes for this. Its textures that are not moved are as UVs say.
#[test]
fn old_versions_of_blender_place_textures_in_an_unknown_way() {
    let lost = |creator: &str, properties: &str| {
        let text = fbx(properties).replace("By hand", creator);
        let document = Document::from_bytes("plate.fbx", text.into_bytes(), None, &LoadOptions::default());
        document.unwrap().provenance().unwrap().not_carried.clone()
    };
    let scaling = vector("Scaling", [2.0, 2.0, 1.0]);
    let unknown = ["the scale, rotation or offset of paint.png"];
    for creator in ["Blender (stable FBX IO) - 2.79 (sub 0) - 3.7.17", "Blender version 2.79"] {
        assert_eq!(lost(creator, &scaling), unknown, "{creator}");
        assert_eq!(lost(creator, ""), [""; 0], "{creator}");
    }
    assert_eq!(lost("Blender (stable FBX IO) - 2.80 (sub 75) - 4.14.14", &scaling), [""; 0]);
}

#[test]
fn clamping_becomes_a_sampler() {
    for (properties, sampler) in [
        (number("WrapModeU", 1) + &number("WrapModeV", 1), r#"{"wrapS":33071,"wrapT":33071}"#),
        (number("WrapModeU", 1), r#"{"wrapS":33071}"#),
        (number("WrapModeV", 1), r#"{"wrapT":33071}"#),
    ] {
        let document = open(&properties);
        let json = document.json();
        assert_eq!(json["textures"][0]["sampler"], 0);
        assert_eq!(json["samplers"].as_array().unwrap().len(), 1);
        assert_eq!(json["samplers"][0].to_string(), sampler);
        assert_eq!(document.provenance().unwrap().not_carried, [""; 0]);
    }
    assert!(open("").json().get("samplers").is_none());
}

/// Blender's FBX exporter and its glTF exporter, each with its own numbers, place the textures of
/// assets/blender/mapping.py alike.
#[test]
fn textures_of_blender_lie_as_in_its_gltf() {
    let folder = Path::new("../../assets/blender");
    let [fbx, gltf] = ["mapping.fbx", "mapping.glb"]
        .map(|name| Document::open(&folder.join(name), &LoadOptions::default()).unwrap());
    assert_eq!(fbx.provenance().unwrap().not_carried, [""; 0]);
    // A node of the type Point has the same numbers in the FBX.
    assert!(
        fbx.warnings().iter().any(|warning| warning.contains("of the type Texture")),
        "{:?}",
        fbx.warnings()
    );
    let textures = |document: &Document| -> Vec<(String, [f64; 5], [u64; 2])> {
        let json = document.json();
        let of_material = |material: &Value| {
            let texture = &material["pbrMetallicRoughness"]["baseColorTexture"];
            let sampler = json["textures"][texture["index"].as_u64().unwrap() as usize]["sampler"].as_u64();
            let wrap = ["wrapS", "wrapT"].map(|name| {
                sampler.and_then(|sampler| json["samplers"][sampler as usize][name].as_u64()).unwrap_or(10497)
            });
            (material["name"].as_str().unwrap().to_owned(), transform(texture), wrap)
        };
        let mut found: Vec<_> = json["materials"].as_array().unwrap().iter().map(of_material).collect();
        found.sort_unstable_by(|a, b| a.0.cmp(&b.0));
        found
    };
    let (of_fbx, of_gltf) = (textures(&fbx), textures(&gltf));
    assert_eq!(of_fbx.len(), 8);
    for ((name, found, wrap), (other, expected, expected_wrap)) in of_fbx.iter().zip(&of_gltf) {
        assert_eq!((name, wrap), (other, expected_wrap));
        let difference = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(difference < 1e-6, "{name}: {found:?}, not {expected:?}");
    }
    let images = fbx.json()["images"].as_array().unwrap().len();
    assert_eq!(images, 1, "one image, repeated and clamped");
}

//! Textures that edits give to materials.

mod support;

use darboux_io::LoadOptions;
use darboux_io::gltf::{Alpha, Document, MaterialTexture, PrimitiveName};
use serde_json::json;
use support::{Builder, SQUARE, reread, run, square};

/// Squares with two UV sets, one for each material given, and the names of their primitives.
fn squares(materials: &[Option<usize>], material: serde_json::Value) -> (Document, Vec<PrimitiveName>) {
    let mut builder = Builder::new();
    builder.material(material);
    let mut attributes = square().attributes(&mut builder);
    attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"].clone();
    let indices = builder.indices(&SQUARE);
    let primitives: Vec<_> = materials
        .iter()
        .map(|material| match material {
            Some(material) => json!({"attributes": attributes, "indices": indices, "material": material}),
            None => json!({"attributes": attributes, "indices": indices}),
        })
        .collect();
    builder.mesh(&primitives);
    let mut document = builder.build();
    let names = run(&mut document).primitives.iter().map(|primitive| primitive.name.clone()).collect();
    (document, names)
}

/// The UV set of each primitive's normal map and its material's name.
fn normal_maps(document: &Document) -> Vec<(u32, Option<String>)> {
    let read = reread(document);
    let primitives = read.gltf.meshes().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>());
    primitives
        .map(|primitive| {
            let material = primitive.material();
            (material.normal_texture().unwrap().tex_coord(), material.name().map(str::to_owned))
        })
        .collect()
}

/// A bake with one UV set per primitive: the map of a primitive must not be read through the UVs of another
/// one.
#[test]
fn primitives_of_one_material_keep_their_own_uv_sets() {
    let material = json!({"name": "stone", "normalTexture": {"index": 0, "texCoord": 1}});
    let (mut document, names) = squares(&[Some(0), Some(0), None, None, Some(0)], material);
    let mapped: Vec<_> = names.into_iter().zip([1, 0, 0, 1, 1]).collect();
    document.set_texture(&[MaterialTexture::Normal], vec![0; 4], "map", &mapped).unwrap();
    let stone = Some("stone".to_owned());
    let expected = [(1, stone.clone()), (0, stone.clone()), (0, None), (1, None), (1, stone)];
    assert_eq!(normal_maps(&document), expected);
}

/// The transform of an old map belongs to its UV set, also where a primitive of another set comes first.
#[test]
fn a_copied_material_keeps_the_transform_of_its_uv_set() {
    let transform = json!({"KHR_texture_transform": {"scale": [2, 2]}});
    let texture = json!({"index": 0, "texCoord": 1, "extensions": transform});
    let (mut document, names) = squares(&[Some(0), Some(0)], json!({"normalTexture": texture}));
    let mapped: Vec<_> = names.into_iter().zip([0, 1]).collect();
    document.set_texture(&[MaterialTexture::Normal], vec![0; 4], "map", &mapped).unwrap();
    let glb = document.to_glb().unwrap();
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let json: serde_json::Value = serde_json::from_slice(&glb[20..20 + length]).unwrap();
    let textures = [0, 1].map(|material| json["materials"][material]["normalTexture"].clone());
    assert_eq!(textures.each_ref().map(|texture| texture["texCoord"].as_u64()), [Some(0), Some(1)]);
    assert_eq!(textures.map(|texture| texture["extensions"].is_object()), [false, true]);
}

/// An edit would have to write members into it.
#[test]
fn colours_of_a_material_that_are_no_object_are_refused() {
    let mut builder = Builder::new();
    builder.material(json!({"pbrMetallicRoughness": 5}));
    let error = builder.read(&LoadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("materials[0].pbrMetallicRoughness: is 5; it must be an object"), "{error}");
}

/// Renderers multiply the base colour by vertex colours, so a new texture would show other colours than its
/// own.
#[test]
fn a_base_colour_takes_the_place_of_vertex_colours() {
    let mut builder = Builder::new();
    let mut attributes = square().attributes(&mut builder);
    attributes["COLOR_0"] = attributes["NORMAL"].clone();
    let targets = json!([{"POSITION": attributes["POSITION"], "COLOR_0": attributes["NORMAL"]}]);
    let indices = builder.indices(&SQUARE);
    let primitive = json!({"attributes": attributes, "indices": indices, "targets": targets});
    builder.mesh(&[primitive.clone(), primitive]);
    let mut document = builder.build();
    let first = run(&mut document).primitives[0].name.clone();
    let color = [MaterialTexture::BaseColor { alpha: None }];
    let with_colors = |document: &Document| {
        let json: serde_json::Value = serde_json::from_str(&document.json().to_string()).unwrap();
        [0, 1].map(|primitive| {
            let primitive = &json["meshes"][0]["primitives"][primitive];
            ["/attributes/COLOR_0", "/targets/0/COLOR_0"].map(|place| primitive.pointer(place).is_some())
        })
    };
    document.set_texture(&[MaterialTexture::Occlusion], vec![0; 4], "map", &[(first.clone(), 0)]).unwrap();
    assert_eq!(with_colors(&document), [[true; 2]; 2]);
    document.set_texture(&color, vec![0; 4], "map", &[(first, 0)]).unwrap();
    assert_eq!(with_colors(&document), [[false; 2], [true; 2]]);
}

/// A material that emitted light and has none in a bake.
#[test]
fn emission_is_removed_with_its_factor_and_strength() {
    let material = json!({
        "name": "lamp",
        "emissiveFactor": [1, 1, 1],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 5}},
    });
    let (mut document, names) = squares(&[Some(0), None], material);
    let all: Vec<_> = names.into_iter().map(|name| (name, 0)).collect();
    document
        .set_texture(&[MaterialTexture::Emissive { strength: 2.0 }], vec![0; 4], "light", &all[..1])
        .unwrap();
    document.remove_emission(&all).unwrap();
    assert_eq!(document.json()["materials"][0].to_string(), r#"{"name":"lamp"}"#);
}

/// A primitive that a map is not for keeps its material: the map's UVs may not be there.
#[test]
fn a_material_of_other_primitives_stays() {
    let (mut document, names) = squares(&[Some(0), Some(0), Some(0)], json!({"name": "stone"}));
    let mapped: Vec<_> = names[..2].iter().map(|name| (name.clone(), 0)).collect();
    for used in [MaterialTexture::Normal, MaterialTexture::Occlusion] {
        document.set_texture(&[used], vec![0; 4], "map", &mapped).unwrap();
    }
    let json: serde_json::Value = serde_json::from_str(&document.json().to_string()).unwrap();
    assert_eq!(json["materials"][0], json!({"name": "stone"}));
    assert_eq!(json["materials"].as_array().map(Vec::len), Some(2), "one copy for both");
    let materials = [0, 1, 2].map(|i| json["meshes"][0]["primitives"][i]["material"].as_u64());
    assert_eq!(materials, [Some(1), Some(1), Some(0)]);
    assert!(json["materials"][1]["normalTexture"].is_object());
}

/// The mode of the material before says nothing about the alpha of a new texture.
#[test]
fn the_alpha_of_a_new_texture_sets_the_mode() {
    let material = |alpha: Option<Alpha>| {
        let old = json!({
            "alphaMode": "MASK",
            "alphaCutoff": 0.25,
            "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]},
        });
        let (mut document, names) = squares(&[Some(0)], old);
        let uses = [MaterialTexture::BaseColor { alpha }];
        document.set_texture(&uses, vec![0; 4], "map", &[(names[0].clone(), 0)]).unwrap();
        let json: serde_json::Value = serde_json::from_str(&document.json().to_string()).unwrap();
        let material = &json["materials"][0];
        let factor = material["pbrMetallicRoughness"]["baseColorFactor"][3].as_f64();
        (material["alphaMode"].as_str().map(str::to_owned), material["alphaCutoff"].as_f64(), factor)
    };
    let mode = |name: &str| Some(name.to_owned());
    assert_eq!(material(None), (mode("MASK"), Some(0.25), Some(0.5)));
    assert_eq!(material(Some(Alpha::Opaque)), (None, None, Some(1.0)));
    assert_eq!(material(Some(Alpha::Mask(0.5))), (mode("MASK"), Some(0.5), Some(1.0)));
    assert_eq!(material(Some(Alpha::Blend)), (mode("BLEND"), None, Some(1.0)));
}

/// Renderers leave the textures of light out where a material is unlit.
#[test]
fn extensions_that_hide_a_new_texture_are_removed() {
    let with = |used: MaterialTexture| {
        let extensions = json!({
            "KHR_materials_unlit": {},
            "KHR_materials_pbrSpecularGlossiness": {},
            "KHR_materials_sheen": {},
        });
        let (mut document, names) = squares(&[Some(0)], json!({"extensions": extensions}));
        document.set_texture(&[used], vec![0; 4], "map", &[(names[0].clone(), 0)]).unwrap();
        let json: serde_json::Value = serde_json::from_str(&document.json().to_string()).unwrap();
        let has =
            |name: &str| json["materials"][0]["extensions"].get(format!("KHR_materials_{name}")).is_some();
        ["unlit", "pbrSpecularGlossiness", "sheen"].map(has)
    };
    assert_eq!(with(MaterialTexture::Normal), [false, true, true]);
    assert_eq!(with(MaterialTexture::BaseColor { alpha: None }), [true, false, true]);
    let packed = MaterialTexture::MetallicRoughness { roughness: true, metalness: true };
    assert_eq!(with(packed), [false, false, true]);
}

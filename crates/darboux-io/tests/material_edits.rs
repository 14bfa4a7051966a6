//! Textures that edits give to materials.

mod support;

use darboux_io::LoadOptions;
use darboux_io::gltf::{Document, MaterialTexture, PrimitiveName};
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

//! What an FBX has and glTF does not is listed, and materials of several programs become what they look like.
#![cfg(feature = "fbx")]

use darboux_io::LoadOptions;
use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents, inspect};

/// An ASCII FBX of one triangle with two UV sets, at the node `Plate`.
#[derive(Clone, Copy, Default)]
struct Parts<'a> {
    /// Within the geometry, before its layers.
    geometry: &'a str,
    /// Within the node.
    model: &'a str,
    /// The properties of the material.
    material: &'a str,
    /// The shading model; none is Phong.
    shading: Option<&'a str>,
    objects: &'a str,
    connections: &'a str,
}

fn fbx(parts: Parts<'_>) -> String {
    let Parts { geometry, model, material, shading, objects, connections } = parts;
    // u of the second set is v of the first.
    let uvs = |index: u8, name: &str| {
        let uvs = ["0,0,1,0,0,0.5", "0,0,0,1,0.5,0"][usize::from(index)];
        format!(
            "LayerElementUV: {index} {{\nVersion: 101\nName: \"{name}\"\nMappingInformationType: \"ByVertice\"\nReferenceInformationType: \"Direct\"\nUV: *6 {{\na: {uvs}\n}}\n}}\n"
        )
    };
    let layer =
        |kind: &str, index: u8| format!("LayerElement:  {{\nType: \"{kind}\"\nTypedIndex: {index}\n}}\n");
    format!(
        "; A comment of another program\nFBXHeaderExtension:  {{\nFBXHeaderVersion: 1003\nFBXVersion: 7400\nCreator: \"By hand\"\n}}\nObjects:  {{\n\
        Geometry: 1, \"Geometry::Plate\", \"Mesh\" {{\nVertices: *9 {{\na: 0,0,0,1,0,0,0,1,0\n}}\nPolygonVertexIndex: *3 {{\na: 0,1,-3\n}}\nGeometryVersion: 124\n{geometry}{}{}\
        Layer: 0 {{\nVersion: 100\n{}{}{}}}\nLayer: 1 {{\nVersion: 100\n{}{}}}\n}}\n\
        Model: 3, \"Model::Plate\", \"Mesh\" {{\nVersion: 232\n{model}}}\n\
        Material: 4, \"Material::Paint\", \"\" {{\nShadingModel: \"{}\"\nProperties70:  {{\n{material}}}\n}}\n{objects}}}\n\
        Connections:  {{\nC: \"OO\",3,0\nC: \"OO\",1,3\nC: \"OO\",4,3\n{connections}}}\n",
        uvs(0, "first"),
        uvs(1, "second"),
        layer("LayerElementUV", 0),
        layer("LayerElementTangent", 0),
        layer("LayerElementBinormal", 0),
        layer("LayerElementUV", 1),
        layer("LayerElementTangent", 1),
        shading.unwrap_or("phong"),
    )
}

fn open(parts: Parts<'_>) -> Document {
    let document = Document::from_bytes("plate.fbx", fbx(parts).into_bytes(), None, &LoadOptions::default());
    document.unwrap_or_else(|error| panic!("{error}"))
}

fn not_carried(parts: Parts<'_>) -> Vec<String> {
    open(parts).provenance().unwrap().not_carried.clone()
}

/// A texture with an embedded PNG header, connected to a property of the material.
fn texture(id: u32, name: &str, property: &str, extra: &str) -> (String, String) {
    (
        format!(
            "Texture: {id}, \"Texture::{name}\", \"\" {{\nType: \"TextureVideoClip\"\nFileName: \"{name}.png\"\nRelativeFilename: \"{name}.png\"\n{extra}}}\n\
            Video: {}, \"Video::{name}\", \"Clip\" {{\nType: \"Clip\"\nFileName: \"{name}.png\"\nRelativeFilename: \"{name}.png\"\nContent: ,\n\"iVBORw0KGgo=\"\n}}\n",
            id + 50
        ),
        format!("C: \"OP\",{id},4, \"{property}\"\nC: \"OO\",{},{id}\n", id + 50),
    )
}

#[test]
fn a_plain_triangle_loses_nothing() {
    let document = open(Parts::default());
    assert_eq!(document.provenance().unwrap().not_carried, [""; 0]);
    let primitive = &document.json()["meshes"][0]["primitives"][0];
    assert!(primitive["attributes"].get("TEXCOORD_1").is_some());
    assert_eq!(document.json()["meshes"][0]["extras"]["uvSetNames"], ["first", "second"]);
}

#[test]
fn hidden_nodes_properties_and_levels_of_detail_are_listed() {
    let model = "Properties70:  {\nP: \"Visibility\", \"Visibility\", \"\", \"A\",0\nP: \"artist\", \"KString\", \"\", \"U\", \"Ada\"\n}\n";
    assert_eq!(
        not_carried(Parts { model, ..Parts::default() }),
        ["1 hidden node, which is shown", "1 node's custom properties"]
    );
    let objects = "Model: 7, \"Model::Levels\", \"LodGroup\" {\nVersion: 232\n}\nNodeAttribute: 8, \"NodeAttribute::Levels\", \"LodGroup\" {\nTypeFlags: \"LodGroup\"\n}\n";
    let connections = "C: \"OO\",7,0\nC: \"OO\",8,7\n";
    assert_eq!(
        not_carried(Parts { objects, connections, ..Parts::default() }),
        ["1 choice of a level of detail: all levels are shown"]
    );
}

#[test]
fn subdivision_and_tangents_of_further_uv_sets_are_listed() {
    let tangents = |index: u8| {
        format!(
            "LayerElementTangent: {index} {{\nVersion: 101\nName: \"\"\nMappingInformationType: \"ByVertice\"\nReferenceInformationType: \"Direct\"\nTangents: *9 {{\na: 1,0,0,1,0,0,1,0,0\n}}\nTangentsW: *3 {{\na: -1,-1,-1\n}}\n}}\n"
        )
    };
    let geometry = format!("Smoothness: 2\n{}{}", tangents(0), tangents(1));
    let document = open(Parts { geometry: &geometry, ..Parts::default() });
    assert_eq!(
        document.provenance().unwrap().not_carried,
        ["1 mesh's tangents of UV sets after the first", "1 subdivision surface, which is read as its cage"]
    );
    let tangents = document.corners().unwrap()[0].vectors::<4>("TANGENT").unwrap().unwrap();
    assert_eq!(tangents[0], [1.0, 0.0, 0.0, -1.0], "the sign of the fourth component");
}

/// A scale along the third axis, as assimp writes it, means nothing.
#[test]
fn textures_that_are_not_moved_lose_nothing() {
    let scaling = "Properties70:  {\nP: \"Scaling\", \"Vector\", \"\", \"A\",1,1,0\n}\n";
    let (objects, connections) = texture(12, "paint", "DiffuseColor", scaling);
    let found = not_carried(Parts { objects: &objects, connections: &connections, ..Parts::default() });
    assert_eq!(found, [""; 0]);
}

/// Textures that have no place, and what textures lose.
#[test]
fn textures_that_are_lost_are_listed() {
    let (objects, connections) = [
        texture(10, "specular", "SpecularColor", ""),
        texture(11, "mirror", "ReflectionFactor", ""),
        texture(
            12,
            "paint",
            "DiffuseColor",
            "Properties70:  {\nP: \"Rotation\", \"Vector\", \"\", \"A\",0,0,30\n}\n",
        ),
    ]
    .into_iter()
    .unzip::<_, _, Vec<String>, Vec<String>>();
    let (objects, connections) = (objects.concat(), connections.concat());
    let found = not_carried(Parts { objects: &objects, connections: &connections, ..Parts::default() });
    assert_eq!(
        found,
        [
            "the specular colour texture of material \"Paint\"",
            "the texture of ReflectionFactor of material \"Paint\"",
            "the scale, rotation or offset of paint.png",
        ]
    );
}

fn shading(parts: Parts<'_>) -> darboux_io::json::Value {
    open(parts).json()["materials"][0].clone()
}

fn number(name: &str, value: f32) -> String {
    format!("P: \"{name}\", \"Number\", \"\", \"A\",{value}\n")
}

fn color(name: &str, [r, g, b]: [f32; 3]) -> String {
    format!("P: \"{name}\", \"Color\", \"\", \"A\",{r},{g},{b}\n")
}

/// Lambert and Phong have transparency where glTF has opacity, and writers disagree about opaque materials.
#[test]
fn transparency_becomes_opacity() {
    for (factor, white, opacity) in [
        (Some(0.25), 1.0, 0.75),
        (Some(0.0), 1.0, 1.0),
        (Some(1.0), 0.0, 1.0),
        (Some(1.0), 1.0, 1.0),
        (None, 0.5, 0.5),
    ] {
        let factor = factor.map_or_else(String::new, |factor| number("TransparencyFactor", factor));
        let material = color("TransparentColor", [white; 3]) + &factor;
        let json = shading(Parts { material: &material, ..Parts::default() });
        assert_eq!(json["pbrMetallicRoughness"]["baseColorFactor"][3], opacity, "{material}");
        assert_eq!(json.get("alphaMode").is_some(), opacity < 1.0);
    }
}

/// A texture replaces the colour of the property in FBX.
#[test]
fn colours_under_textures_do_not_count() {
    let (objects, connections) =
        [texture(10, "paint", "DiffuseColor", ""), texture(11, "glow", "EmissiveColor", "")]
            .into_iter()
            .unzip::<_, _, Vec<String>, Vec<String>>();
    let (objects, connections) = (objects.concat(), connections.concat());
    let material = color("DiffuseColor", [0.5, 0.5, 0.5])
        + &number("DiffuseFactor", 0.5)
        + &color("EmissiveColor", [0.0; 3])
        + &number("EmissiveFactor", 1.0);
    let json = shading(Parts {
        material: &material,
        objects: &objects,
        connections: &connections,
        ..Parts::default()
    });
    assert_eq!(json["pbrMetallicRoughness"]["baseColorFactor"], [0.5, 0.5, 0.5, 1.0]);
    assert!(json["pbrMetallicRoughness"]["baseColorTexture"].is_object());
    assert_eq!(json["emissiveFactor"], [1.0, 1.0, 1.0]);
    let json = shading(Parts { material: &material, ..Parts::default() });
    assert_eq!(json["pbrMetallicRoughness"]["baseColorFactor"], [0.25, 0.25, 0.25, 1.0]);
}

/// A vertex without weights, more than eight weights, and dual quaternions.
#[test]
fn skins_that_lose_something_are_listed() {
    let mut objects =
        "Deformer: 20, \"Deformer::Skin\", \"Skin\" {\nVersion: 101\nSkinningType: \"DualQuaternion\"\n}\n"
            .to_owned();
    let mut connections = "C: \"OO\",20,1\n".to_owned();
    for bone in 0..10 {
        let (node, cluster) = (30 + bone, 50 + bone);
        objects += &format!("Model: {node}, \"Model::Bone{bone}\", \"LimbNode\" {{\nVersion: 232\n}}\n");
        objects += &format!(
            "Deformer: {cluster}, \"SubDeformer::Cluster{bone}\", \"Cluster\" {{\nVersion: 100\nIndexes: *2 {{\na: 0,1\n}}\nWeights: *2 {{\na: 0.1,0.1\n}}\nTransform: *16 {{\na: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1\n}}\nTransformLink: *16 {{\na: 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1\n}}\n}}\n"
        );
        connections += &format!("C: \"OO\",{node},0\nC: \"OO\",{cluster},20\nC: \"OO\",{node},{cluster}\n");
    }
    let found = not_carried(Parts { objects: &objects, connections: &connections, ..Parts::default() });
    assert_eq!(
        found,
        [
            "all but the 8 largest of up to 10 weights of the vertices of \"Plate\"",
            "the place of 1 vertex of \"Plate\" without weights, which follow the first joint",
            "the dual quaternions of the skin of \"Plate\", which is linear in glTF",
        ]
    );
}

/// A shape that is reached at half the weight of its channel.
#[test]
fn shapes_have_their_weight_as_a_part_of_the_full_weight() {
    let objects = "Geometry: 20, \"Geometry::Up\", \"Shape\" {\nVersion: 100\nIndexes: *1 {\na: 1\n}\nVertices: *3 {\na: 0,0,1\n}\nNormals: *3 {\na: 0,0.5,0\n}\n}\n\
        Deformer: 21, \"Deformer::Shapes\", \"BlendShape\" {\nVersion: 100\n}\n\
        Deformer: 22, \"SubDeformer::Up\", \"BlendShapeChannel\" {\nVersion: 100\nDeformPercent: 25\nFullWeights: *1 {\na: 50\n}\n}\n";
    let connections = "C: \"OO\",20,22\nC: \"OO\",22,21\nC: \"OO\",21,1\n";
    let document = open(Parts { objects, connections, ..Parts::default() });
    assert_eq!(document.json()["meshes"][0]["weights"], [0.5]);
    let target = &document.json()["meshes"][0]["primitives"][0]["targets"][0];
    let offsets = |name: &str| document.vectors::<3>(target[name].as_u64().unwrap() as usize).unwrap();
    assert_eq!(offsets("POSITION").iter().filter(|offset| **offset == [0.0, 0.0, 1.0]).count(), 1);
    assert_eq!(offsets("NORMAL").iter().filter(|offset| **offset == [0.0, 0.5, 0.0]).count(), 1);
}

/// A node that mirrors has a mirrored matrix, and the mesh keeps its vertices and its tangents' sign.
#[test]
fn mirrored_nodes_keep_their_meshes() {
    let model = "Properties70:  {\nP: \"Lcl Scaling\", \"Lcl Scaling\", \"\", \"A\",-1,1,1\nP: \"GeometricScaling\", \"Vector3D\", \"Vector\", \"\",1,-1,1\n}\n";
    let (plain, mirrored) = (open(Parts::default()), open(Parts { model, ..Parts::default() }));
    let positions = |document: &Document| document.corners().unwrap()[0].vectors::<3>("POSITION").unwrap();
    assert_eq!(positions(&plain), positions(&mirrored));
    let matrix = |document: &Document| document.mesh_instances().unwrap().meshes[0].matrices[0];
    // Both scales, one of them in a helper node.
    let expected = matrix(&plain).map(|column| column);
    let found = matrix(&mirrored);
    for (axis, sign) in [(0, -1.0), (1, -1.0), (2, 1.0)] {
        assert_eq!(found[axis], expected[axis].map(|x| x * sign + 0.0), "column {axis}");
    }
}

/// A file of animations, for example.
#[test]
fn a_file_without_meshes_says_so() {
    let fbx = fbx(Parts::default()).replace("C: \"OO\",1,3\n", "");
    let document = Document::from_bytes("a.fbx", fbx.into_bytes(), None, &LoadOptions::default()).unwrap();
    let sentence = "there are no meshes in the file; if there should be, export it again with its meshes";
    assert_eq!(document.warnings(), [sentence]);
}

/// A texture names its UV set, and the tangents follow that of the normal map.
#[test]
fn textures_name_their_uv_set() {
    let opened = |set: &str| {
        let uv_set = format!("Properties70:  {{\nP: \"UVSet\", \"KString\", \"\", \"\", \"{set}\"\n}}\n");
        let (objects, connections) = texture(12, "bumps", "NormalMap", &uv_set);
        open(Parts { objects: &objects, connections: &connections, ..Parts::default() })
    };
    let missing =
        "bumps.png is placed by the UV set \"third\", which its mesh does not have; the first set is taken";
    for (set, place, warning) in [
        ("", 0, None),
        ("default", 0, None),
        ("first", 0, None),
        ("second", 1, None),
        ("third", 0, Some(missing)),
    ] {
        let mut document = opened(set);
        let warnings = document.warnings().to_vec();
        let found = warnings.iter().find(|warning| warning.contains("UV set"));
        assert_eq!(found.map(String::as_str), warning, "{set}: {warnings:?}");
        let texture = &document.json()["materials"][0]["normalTexture"];
        assert_eq!(texture.get("texCoord").and_then(|set| set.as_u64()).unwrap_or(0), place, "{set}");
        add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {}).unwrap();
        let corners = document.corners().unwrap();
        let tangents = corners[0].vectors::<4>("TANGENT").unwrap().unwrap();
        let expected = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, -1.0]][place as usize];
        assert_eq!(tangents[0], expected, "{set}");
    }
}

/// Meshes that share a material may have the set that its texture names at other places, or not at all.
#[test]
fn a_uv_set_is_looked_up_in_each_mesh() {
    let uv_set = "Properties70:  {\nP: \"UVSet\", \"KString\", \"\", \"\", \"second\"\n}\n";
    let (textures, connections) = texture(12, "bumps", "NormalMap", uv_set);
    for (name, place, warnings) in [("second", 0, 0), ("other", 0, 1)] {
        let other = format!(
            "Geometry: 6, \"Geometry::Other\", \"Mesh\" {{\nVertices: *9 {{\na: 0,0,0,1,0,0,0,1,0\n}}\nPolygonVertexIndex: *3 {{\na: 0,1,-3\n}}\nGeometryVersion: 124\n\
            LayerElementUV: 0 {{\nVersion: 101\nName: \"{name}\"\nMappingInformationType: \"ByVertice\"\nReferenceInformationType: \"Direct\"\nUV: *6 {{\na: 0,0,1,0,0,1\n}}\n}}\n\
            Layer: 0 {{\nVersion: 100\nLayerElement:  {{\nType: \"LayerElementUV\"\nTypedIndex: 0\n}}\n}}\n}}\n\
            Model: 7, \"Model::Other\", \"Mesh\" {{\nVersion: 232\n}}\n"
        );
        let objects = format!("{other}{textures}");
        let connections = format!("C: \"OO\",7,0\nC: \"OO\",6,7\nC: \"OO\",4,7\n{connections}");
        let document = open(Parts { objects: &objects, connections: &connections, ..Parts::default() });
        let json = document.json();
        let set_of_mesh = |name: &str| {
            let meshes = json["meshes"].as_array().unwrap();
            let mesh = meshes.iter().find(|mesh| mesh["name"] == name).unwrap();
            let material = mesh["primitives"][0]["material"].as_u64().unwrap() as usize;
            json["materials"][material]["normalTexture"]
                .get("texCoord")
                .and_then(|set| set.as_u64())
                .unwrap_or(0)
        };
        assert_eq!((set_of_mesh("Plate"), set_of_mesh("Other")), (1, place), "{name}");
        assert_eq!(json["materials"].as_array().unwrap().len(), 2, "{name}");
        assert_eq!(json["images"].as_array().unwrap().len(), 1, "{name}");
        let found = document.warnings().iter().filter(|warning| warning.contains("UV set")).count();
        assert_eq!(found, warnings, "{name}: {:?}", document.warnings());
    }
}

/// The tangents of a surface whose normal map is not read are used: the map is in the file of the model.
#[test]
fn normal_maps_that_are_not_read_need_tangents() {
    let uv_set = "Properties70:  {\nP: \"UVSet\", \"KString\", \"\", \"\", \"second\"\n}\n";
    for (content, is_absent, problem) in [
        ("", true, "is not in the model's folder"),
        ("Content: ,\n\"Qk0gYW5kIHNvIG9u\"\n", false, "is BMP, which is not read; save it as PNG"),
    ] {
        let objects = format!(
            "Texture: 12, \"Texture::bumps\", \"\" {{\nType: \"TextureVideoClip\"\nFileName: \"bumps.png\"\nRelativeFilename: \"bumps.png\"\n{uv_set}}}\n\
            Video: 62, \"Video::bumps\", \"Clip\" {{\nType: \"Clip\"\nFileName: \"bumps.png\"\nRelativeFilename: \"bumps.png\"\n{content}}}\n"
        );
        let connections = "C: \"OP\",12,4, \"NormalMap\"\nC: \"OO\",62,12\n";
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plate.fbx");
        std::fs::write(&path, fbx(Parts { objects: &objects, connections, ..Parts::default() })).unwrap();
        let document = Document::open(&path, &LoadOptions::default()).unwrap();
        let unread = &document.provenance().unwrap().unread_maps;
        let told: Vec<_> = unread
            .iter()
            .map(|map| (map.material, map.uv_set, &*map.file, &*map.problem, map.is_absent))
            .collect();
        assert_eq!(told, [(0, 1, "bumps.png", problem, is_absent)]);
        let info = &inspect(&document).unwrap()[0];
        assert!(info.needs_tangents);
        assert_eq!(info.uv_set, 1, "the set that the texture names");
    }
    let without = inspect(&open(Parts::default())).unwrap();
    assert!(!without[0].needs_tangents);
}

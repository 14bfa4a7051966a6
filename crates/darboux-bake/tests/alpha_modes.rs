//! The modes of alpha of the materials of a document.

use darboux_bake::{AlphaMode, HighModel, HighModelOptions};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;

/// A triangle per primitive, each with what its JSON has beside the positions. `materials`: their JSON.
fn mode_of(materials: &str, primitives: &[&str]) -> AlphaMode {
    let primitives: Vec<String> =
        primitives.iter().map(|more| format!("{{\"attributes\": {{\"POSITION\": 0}}{more}}}")).collect();
    let mut json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
            "meshes": [{{"primitives": [{}]}}, {{"primitives": [{{"attributes": {{"POSITION": 0}}, "material": 2}}]}}],
            "materials": [{materials}], "buffers": [{{"byteLength": 36}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                "min": [0, 0, 0], "max": [1, 1, 0]}}]}}"#,
        primitives.join(", ")
    )
    .into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let positions: Vec<u8> =
        [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let mut glb = b"glTF\x02\0\0\0".to_vec();
    glb.extend(((28 + json.len() + positions.len()) as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &positions)] {
        glb.extend((chunk.len() as u32).to_le_bytes());
        glb.extend(kind);
        glb.extend(chunk);
    }
    let document = Document::from_bytes("model.glb", glb, None, &LoadOptions::default()).expect("a model");
    let corners = document.corners().expect("valid data");
    HighModel::read(&document, &corners, &HighModelOptions::default()).expect("valid data").alpha_mode()
}

/// The second mesh is not in the scene.
#[test]
fn the_last_mode_of_the_materials_in_the_scene_counts() {
    let materials = r#"{}, {"alphaMode": "MASK"}, {"alphaMode": "BLEND"}"#;
    let [opaque, mask, blend] = [0, 1, 2].map(|index| format!(", \"material\": {index}"));
    let mode = |primitives: &[&str]| mode_of(materials, primitives);
    assert_eq!(mode(&[""]), AlphaMode::Opaque);
    assert_eq!(mode(&["", &opaque]), AlphaMode::Opaque);
    assert_eq!(mode(&[&mask, &opaque]), AlphaMode::Mask);
    assert_eq!(mode(&[&mask, &blend, ""]), AlphaMode::Blend);
}

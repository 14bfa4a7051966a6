//! Finds extensions of a primitive that refer to vertices and are not updated when vertices are split.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::Value;

use super::name::PrimitiveName;
use crate::gltf::Document;

/// All extensions of a primitive, by name.
#[derive(Deserialize)]
struct AllExtensions {
    #[serde(default)]
    extensions: BTreeMap<String, Value>,
}

/// Extensions that refer to materials, textures or attributes, or depend on the order of triangles only.
const UNAFFECTED_EXTENSIONS: [&str; 4] =
    ["KHR_materials_variants", "KHR_draco_mesh_compression", "EXT_structural_metadata", "FB_ngon_encoding"];

/// The extensions in the JSON of a primitive that may refer to vertices, by index or through accessors.
fn affected_extensions(primitive: &str) -> Vec<String> {
    let Ok(AllExtensions { extensions }) = serde_json::from_str(primitive) else { return Vec::new() };
    let affected = extensions.into_iter().filter(|(name, json)| match name.as_str() {
        "EXT_mesh_features" => numbers_vertices(json),
        name => !UNAFFECTED_EXTENSIONS.contains(&name) && mentions_vertices(json),
    });
    affected.map(|(name, _)| name).collect()
}

/// The warning about extensions of a primitive whose vertices are split, if there are any.
pub fn warning(document: &Document, name: &PrimitiveName) -> Option<String> {
    let extensions = affected_extensions(document.primitive_text(name.mesh, name.primitive)?);
    (!extensions.is_empty()).then(|| {
        let names = extensions.join(", ");
        format!("{name}: vertices were split, but {names} may refer to the old ones; check the model if you use it")
    })
}

/// Whether a feature of `EXT_mesh_features` is identified by the vertex index: it has neither an attribute nor a texture.
fn numbers_vertices(json: &Value) -> bool {
    let features = json.get("featureIds").and_then(Value::as_array).into_iter().flatten();
    features.into_iter().any(|feature| feature.get("attribute").is_none() && feature.get("texture").is_none())
}

/// Whether `json` has a member, at any depth, that may refer to accessors.
fn mentions_vertices(json: &Value) -> bool {
    match json {
        Value::Object(members) => members.iter().any(|(key, value)| {
            matches!(key.as_str(), "attributes" | "indices" | "accessor" | "accessors" | "targets")
                || mentions_vertices(value)
        }),
        Value::Array(values) => values.iter().any(mentions_vertices),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::affected_extensions;

    #[test]
    fn extensions_with_vertices_of_their_own_are_named() {
        let primitive = r#"{"attributes":{"POSITION":0},"extensions":{
            "CESIUM_primitive_outline":{"indices":7},
            "KHR_materials_variants":{"mappings":[{"material":0,"variants":[0]}]},
            "EXT_structural_metadata":{"propertyAttributes":[0]},
            "VENDOR_deep":{"a":[{"accessor":1}]},
            "VENDOR_other":{"strength":1}}}"#;
        assert_eq!(affected_extensions(primitive), ["CESIUM_primitive_outline", "VENDOR_deep"]);
    }

    #[test]
    fn features_by_vertex_number_are_named() {
        let with = |feature: &str| {
            let ids = format!(r#"{{"featureIds":[{{"featureCount":4{feature}}}]}}"#);
            affected_extensions(&format!(r#"{{"extensions":{{"EXT_mesh_features":{ids}}}}}"#))
        };
        assert_eq!(with(""), ["EXT_mesh_features"]);
        assert_eq!(with(r#","attribute":0"#), [] as [String; 0]);
    }
}

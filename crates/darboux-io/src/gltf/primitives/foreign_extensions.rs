//! Finds extensions of a primitive that refer to vertices and are not updated when vertices are split.

use crate::json::Value;

use super::name::PrimitiveName;
use crate::gltf::Document;

/// Extensions that refer to materials, textures or attributes, or depend on the order of triangles only.
const UNAFFECTED_EXTENSIONS: [&str; 4] =
    ["KHR_materials_variants", "KHR_draco_mesh_compression", "EXT_structural_metadata", "FB_ngon_encoding"];

/// The extensions of a primitive that may refer to vertices, by index or through accessors, in order of
/// names.
fn affected_extensions(primitive: &Value) -> Vec<&str> {
    let extensions = primitive["extensions"].as_object().into_iter().flatten();
    let affected = extensions.filter(|(name, json)| match name.as_str() {
        "EXT_mesh_features" => numbers_vertices(json),
        name => !UNAFFECTED_EXTENSIONS.contains(&name) && mentions_vertices(json),
    });
    let mut names: Vec<&str> = affected.map(|(name, _)| name.as_str()).collect();
    names.sort_unstable();
    names
}

/// The warning about extensions of a primitive whose vertices are split, if there are any.
pub fn warning(document: &Document, name: &PrimitiveName) -> Option<String> {
    let primitive = &document.element("meshes", name.mesh)["primitives"][name.primitive];
    let extensions = affected_extensions(primitive);
    (!extensions.is_empty()).then(|| {
        let names = extensions.join(", ");
        format!(
            "{name}: vertices were split, but {names} may refer to the old ones; check the model if you \
             use it"
        )
    })
}

/// Whether a feature of `EXT_mesh_features` is identified by the vertex index: it has neither an attribute
/// nor a texture.
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
    use crate::json::parse_test as parse;

    #[test]
    fn extensions_with_vertices_of_their_own_are_named() {
        let primitive = r#"{"attributes":{"POSITION":0},"extensions":{
            "CESIUM_primitive_outline":{"indices":7},
            "KHR_materials_variants":{"mappings":[{"material":0,"variants":[0]}]},
            "EXT_structural_metadata":{"propertyAttributes":[0]},
            "VENDOR_deep":{"a":[{"accessor":1}]},
            "VENDOR_other":{"strength":1}}}"#;
        let primitive = parse(primitive).unwrap();
        assert_eq!(affected_extensions(&primitive), ["CESIUM_primitive_outline", "VENDOR_deep"]);
    }

    #[test]
    fn features_by_vertex_number_are_named() {
        let with = |feature: &str| {
            let ids = format!(r#"{{"featureIds":[{{"featureCount":4{feature}}}]}}"#);
            let primitive = parse(&format!(r#"{{"extensions":{{"EXT_mesh_features":{ids}}}}}"#)).unwrap();
            affected_extensions(&primitive) == ["EXT_mesh_features"]
        };
        assert!(with(""));
        assert!(!with(r#","attribute":0"#));
    }
}

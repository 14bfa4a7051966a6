//! Where a document's JSON names accessors and buffer views by their numbers.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fmt;
use std::ops::Range;

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::value::RawValue;

use super::json_text::range_in;

/// What a number names, and who names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceKind {
    /// An accessor.
    Accessor,
    /// A buffer view, named by an accessor.
    ViewOfAccessor,
    /// A buffer view, named by anything else.
    View,
}

/// A number that names something.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IndexReference {
    pub kind: ReferenceKind,
    pub number: usize,
    /// Where it stands in the text.
    pub range: Range<usize>,
}

/// Keys from the root to a number; [`ANY`] stands for every key and every place in an array.
type Path = &'static [&'static str];

const ANY: &str = "*";

/// glTF 2.0, and the extensions whose references are known.
const PATHS: &[(ReferenceKind, Path)] = &[
    (ReferenceKind::Accessor, &["meshes", ANY, "primitives", ANY, "attributes", ANY]),
    (ReferenceKind::Accessor, &["meshes", ANY, "primitives", ANY, "indices"]),
    (ReferenceKind::Accessor, &["meshes", ANY, "primitives", ANY, "targets", ANY, ANY]),
    (
        ReferenceKind::Accessor,
        &["meshes", ANY, "primitives", ANY, "extensions", "CESIUM_primitive_outline", "indices"],
    ),
    (ReferenceKind::Accessor, &["skins", ANY, "inverseBindMatrices"]),
    (ReferenceKind::Accessor, &["animations", ANY, "samplers", ANY, "input"]),
    (ReferenceKind::Accessor, &["animations", ANY, "samplers", ANY, "output"]),
    (ReferenceKind::Accessor, &["nodes", ANY, "extensions", "EXT_mesh_gpu_instancing", "attributes", ANY]),
    (ReferenceKind::ViewOfAccessor, &["accessors", ANY, "bufferView"]),
    (ReferenceKind::ViewOfAccessor, &["accessors", ANY, "sparse", "indices", "bufferView"]),
    (ReferenceKind::ViewOfAccessor, &["accessors", ANY, "sparse", "values", "bufferView"]),
    (ReferenceKind::View, &["images", ANY, "bufferView"]),
    (
        ReferenceKind::View,
        &["meshes", ANY, "primitives", ANY, "extensions", "KHR_draco_mesh_compression", "bufferView"],
    ),
    (ReferenceKind::View, &["extensions", "KHR_audio_emitter", "audio", ANY, "bufferView"]),
    (
        ReferenceKind::View,
        &["extensions", "EXT_structural_metadata", "propertyTables", ANY, "properties", ANY, "values"],
    ),
    (
        ReferenceKind::View,
        &["extensions", "EXT_structural_metadata", "propertyTables", ANY, "properties", ANY, "arrayOffsets"],
    ),
    (
        ReferenceKind::View,
        &["extensions", "EXT_structural_metadata", "propertyTables", ANY, "properties", ANY, "stringOffsets"],
    ),
];

/// Extensions that name accessors and buffer views at [`PATHS`] only, or nowhere.
const KNOWN: &[&str] = &[
    "AGI_articulations",
    "AGI_stk_metadata",
    "CESIUM_RTC",
    "CESIUM_primitive_outline",
    "EXT_instance_features",
    "EXT_lights_image_based",
    "EXT_mesh_features",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_structural_metadata",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "FB_ngon_encoding",
    "KHR_animation_pointer",
    "KHR_audio_emitter",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_lod",
    "MSFT_packing_normalRoughnessMetallic",
    "MSFT_packing_occlusionRoughnessMetallic",
    "MSFT_texture_dds",
    "VRM",
    "VRMC_node_constraint",
    "VRMC_springBone",
    "VRMC_vrm",
];

/// Families of extensions of materials, which name textures only.
const KNOWN_FAMILIES: &[&str] = &["KHR_materials_", "EXT_materials_", "ADOBE_materials_", "VRMC_materials_"];

/// Every reference in `json`, in the order of the text. None: one of them is no number.
pub fn references(json: &str) -> Option<Vec<IndexReference>> {
    let mut found = Vec::new();
    let walk = Walk { json, paths: PATHS.to_vec(), found: &mut found };
    walk.deserialize(&mut serde_json::Deserializer::from_str(json)).ok()?;
    Some(found)
}

/// The first extension in `json`, by its name, that may name accessors or buffer views at places that are not known.
pub fn unknown_extension(json: &str) -> Option<String> {
    let is_known =
        |name: &str| KNOWN.contains(&name) || KNOWN_FAMILIES.iter().any(|family| name.starts_with(family));
    extension_names(json).into_iter().find(|name| !is_known(name))
}

/// The keys of every object that is a member `extensions`, at any depth.
fn extension_names(json: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut is_extensions = Vec::new();
    let mut key = None;
    let mut rest = json;
    while let Some(at) = rest.find(['{', '[', '}', ']', '"']) {
        let token = rest.as_bytes()[at];
        rest = &rest[at..];
        let mut length = 1;
        match token {
            b'{' => is_extensions.push(key.take().as_deref() == Some("extensions")),
            b'[' => is_extensions.push(false),
            b'"' => {
                length = string_length(rest);
                let after = rest[length..].trim_start();
                key =
                    after.starts_with(':').then(|| serde_json::from_str(&rest[..length]).unwrap_or_default());
                names.extend(key.clone().filter(|_| is_extensions.last() == Some(&true)));
            }
            _ => drop(is_extensions.pop()),
        }
        rest = &rest[length..];
    }
    names
}

/// The length of the string that `text` begins with, quotes included.
fn string_length(text: &str) -> usize {
    let mut escaped = false;
    let end = text.bytes().skip(1).position(|byte| {
        let ends = byte == b'"' && !escaped;
        escaped = byte == b'\\' && !escaped;
        ends
    });
    end.map_or(text.len(), |end| end + 2)
}

/// A value on the way to numbers.
struct Walk<'t, 'f> {
    json: &'t str,
    /// What is left of the paths that lead here.
    paths: Vec<(ReferenceKind, Path)>,
    found: &'f mut Vec<IndexReference>,
}

impl<'t> Walk<'t, '_> {
    /// The paths that go on at `key`; none for those that do not.
    fn step(&self, key: &str) -> Vec<(ReferenceKind, Path)> {
        let goes_on = |&(kind, path): &(ReferenceKind, Path)| match path.split_first() {
            Some((first, rest)) if *first == ANY || *first == key => Some((kind, rest)),
            _ => None,
        };
        self.paths.iter().filter_map(goes_on).collect()
    }

    fn at<'n>(&'n mut self, key: &str) -> Walk<'t, 'n> {
        Walk { json: self.json, paths: self.step(key), found: self.found }
    }
}

impl<'t> DeserializeSeed<'t> for Walk<'t, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'t>>(self, deserializer: D) -> Result<(), D::Error> {
        if self.paths.is_empty() {
            return deserializer.deserialize_ignored_any(IgnoredAny).map(drop);
        }
        let Some(&(kind, _)) = self.paths.iter().find(|(_, path)| path.is_empty()) else {
            return deserializer.deserialize_any(self);
        };
        let raw = <&RawValue as serde::Deserialize>::deserialize(deserializer)?.get();
        let number = raw.parse().map_err(|_| serde::de::Error::custom("not a number"))?;
        self.found.push(IndexReference { kind, number, range: range_in(self.json, raw) });
        Ok(())
    }
}

impl<'t> Visitor<'t> for Walk<'t, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object or an array")
    }

    fn visit_map<A: MapAccess<'t>>(mut self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<Cow<'t, str>>()? {
            map.next_value_seed(self.at(&key))?;
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'t>>(mut self, mut sequence: A) -> Result<(), A::Error> {
        while sequence.next_element_seed(self.at(ANY))?.is_some() {}
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found_where_they_stand() {
        let json = r#"{"skins": [{"inverseBindMatrices" : 12}], "extras": {"skins": [{"inverseBindMatrices": 1}]},
            "accessors": [{"bufferView": 3, "count": 5}], "images": [{"uri": "a"}, {"bufferView":4}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "_\u0041": 7}, "targets": [{"NORMAL": 2}]}]}]}"#;
        let found = references(json).unwrap();
        for reference in &found {
            assert_eq!(json[reference.range.clone()], reference.number.to_string());
        }
        let of = |kind: ReferenceKind| {
            let of_kind = found.iter().filter(|reference| reference.kind == kind);
            of_kind.map(|reference| reference.number).collect::<Vec<_>>()
        };
        assert_eq!(of(ReferenceKind::Accessor), [12, 0, 7, 2]);
        assert_eq!((of(ReferenceKind::ViewOfAccessor), of(ReferenceKind::View)), (vec![3], vec![4]));
        assert_eq!(references(r#"{"skins": [{"inverseBindMatrices": -1}]}"#), None);
        assert_eq!(references(r#"{"skins": 5}"#), None);
    }

    #[test]
    fn extensions_are_found_at_any_depth_and_not_in_texts() {
        let known = r#"{"extensions": {"KHR_materials_unlit": {"extensions": {"KHR_xmp": {}}}}, "extras": "{\"extensions\":{\"A\":1}}",
            "name": "\\", "nodes": [{"extensions": {}, "B": {"C": 1}}]}"#;
        assert_eq!(unknown_extension(known), None);
        for json in [
            r#"{"nodes": [{"extensions" : {"KHR_xmp": {"a": [1, {}]}, "VENDOR_\u0061": {}}}]}"#,
            r#"{"extensions": {"KHR_xmp": {"extensions": {"VENDOR_a": 1}}}}"#,
        ] {
            assert_eq!(unknown_extension(json).as_deref(), Some("VENDOR_a"), "{json}");
        }
        let deep =
            format!("{}{{\"extensions\":{{\"VENDOR_a\":1}}}}{}", "[".repeat(500_000), "]".repeat(500_000));
        assert_eq!(unknown_extension(&deep).as_deref(), Some("VENDOR_a"));
    }
}

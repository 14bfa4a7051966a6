//! Finds and checks the references in a document's JSON: indices into its arrays, such as the accessor of an attribute.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::Range;

use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::value::RawValue;

use super::json_text::range_in;
use crate::error::ContentError;

/// What a reference refers to. Buffer views are told apart by what refers to them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceKind {
    Accessor,
    /// A buffer view, referred to by an accessor.
    ViewOfAccessor,
    /// A buffer view, referred to by anything else.
    View,
    Buffer,
    Camera,
    Image,
    Material,
    Mesh,
    Node,
    Sampler,
    Scene,
    Skin,
    Texture,
}

impl ReferenceKind {
    /// The array that the reference is an index of, and the name of one of its elements.
    fn array(self) -> (&'static str, &'static str) {
        match self {
            Self::Accessor => ("accessors", "accessor"),
            Self::ViewOfAccessor | Self::View => ("bufferViews", "buffer view"),
            Self::Buffer => ("buffers", "buffer"),
            Self::Camera => ("cameras", "camera"),
            Self::Image => ("images", "image"),
            Self::Material => ("materials", "material"),
            Self::Mesh => ("meshes", "mesh"),
            Self::Node => ("nodes", "node"),
            Self::Sampler => ("samplers", "sampler"),
            Self::Scene => ("scenes", "scene"),
            Self::Skin => ("skins", "skin"),
            Self::Texture => ("textures", "texture"),
        }
    }
}

/// A reference in JSON text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IndexReference {
    pub kind: ReferenceKind,
    pub index: usize,
    /// The range of the number in the text.
    pub range: Range<usize>,
}

/// Keys from the root to a number. [`ANY`] stands for every key and every index.
type Path = &'static [&'static str];

const ANY: &str = "*";

/// The paths of references in glTF 2.0 and in the extensions of [`KNOWN_EXTENSIONS`].
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
    (ReferenceKind::Buffer, &["bufferViews", ANY, "buffer"]),
    (ReferenceKind::Buffer, &["bufferViews", ANY, "extensions", "EXT_meshopt_compression", "buffer"]),
    (ReferenceKind::Buffer, &["bufferViews", ANY, "extensions", "KHR_meshopt_compression", "buffer"]),
    (ReferenceKind::Camera, &["nodes", ANY, "camera"]),
    (ReferenceKind::Image, &["textures", ANY, "source"]),
    (ReferenceKind::Material, &["meshes", ANY, "primitives", ANY, "material"]),
    (
        ReferenceKind::Material,
        &[
            "meshes",
            ANY,
            "primitives",
            ANY,
            "extensions",
            "KHR_materials_variants",
            "mappings",
            ANY,
            "material",
        ],
    ),
    (ReferenceKind::Mesh, &["nodes", ANY, "mesh"]),
    (ReferenceKind::Node, &["nodes", ANY, "children", ANY]),
    (ReferenceKind::Node, &["scenes", ANY, "nodes", ANY]),
    (ReferenceKind::Node, &["skins", ANY, "joints", ANY]),
    (ReferenceKind::Node, &["skins", ANY, "skeleton"]),
    (ReferenceKind::Node, &["animations", ANY, "channels", ANY, "target", "node"]),
    (ReferenceKind::Sampler, &["textures", ANY, "sampler"]),
    (ReferenceKind::Scene, &["scene"]),
    (ReferenceKind::Skin, &["nodes", ANY, "skin"]),
    (ReferenceKind::Texture, &["materials", ANY, "pbrMetallicRoughness", "baseColorTexture", "index"]),
    (
        ReferenceKind::Texture,
        &["materials", ANY, "pbrMetallicRoughness", "metallicRoughnessTexture", "index"],
    ),
    (ReferenceKind::Texture, &["materials", ANY, "normalTexture", "index"]),
    (ReferenceKind::Texture, &["materials", ANY, "occlusionTexture", "index"]),
    (ReferenceKind::Texture, &["materials", ANY, "emissiveTexture", "index"]),
];

/// Extensions that refer to accessors and buffer views at [`PATHS`] only, or not at all.
const KNOWN_EXTENSIONS: &[&str] = &[
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

/// Prefixes of material extensions, which refer to textures only.
const KNOWN_FAMILIES: &[&str] = &["KHR_materials_", "EXT_materials_", "ADOBE_materials_", "VRMC_materials_"];

/// All references in `json`, in the order of the text. None: one of them is not an index.
pub fn references(json: &str) -> Option<Vec<IndexReference>> {
    Some(scan(json).ok()?.references)
}

/// Checks that every reference in the JSON of a document refers to an element that exists.
pub fn check(json: &str) -> Result<(), ContentError> {
    let ReferenceScan { references, counts, .. } = match scan(json) {
        Ok(found) => found,
        Err(Some(offset)) => {
            return Err(ContentError::invalid(
                path_at(json, offset),
                "is not an index; export the file again",
            ));
        }
        // The same text has been parsed before, so that other failures cannot be.
        Err(None) => return Ok(()),
    };
    for IndexReference { kind, index, range } in references {
        let (array, element) = kind.array();
        let count = counts.get(array).copied().unwrap_or(0);
        // A default scene without scenes is harmless: everything is shown.
        if index >= count && (kind, count) != (ReferenceKind::Scene, 0) {
            let problem =
                format!("{element} {index} does not exist: there are {count}; export the file again");
            return Err(ContentError::invalid(path_at(json, range.start), problem));
        }
    }
    if counts.contains_key("animations") { check_animations(json) } else { Ok(()) }
}

/// Checks the references of animation channels to the samplers of their own animation.
fn check_animations(json: &str) -> Result<(), ContentError> {
    #[derive(Deserialize)]
    struct Animations {
        animations: Vec<AnimationReferences>,
    }
    #[derive(Deserialize)]
    struct AnimationReferences {
        #[serde(default)]
        channels: Vec<SamplerReference>,
        #[serde(default)]
        samplers: Vec<IgnoredAny>,
    }
    #[derive(Deserialize)]
    struct SamplerReference {
        sampler: usize,
    }
    let parsed: Result<Animations, _> = serde_json::from_str(json);
    let animations = parsed.map_err(|error| {
        ContentError::invalid("animations", format!("cannot be read: {error}; export the file again"))
    })?;
    for (i, AnimationReferences { channels, samplers }) in animations.animations.iter().enumerate() {
        for (k, SamplerReference { sampler }) in channels.iter().enumerate() {
            if *sampler >= samplers.len() {
                let at = format!("animations[{i}].channels[{k}].sampler");
                let problem = format!("sampler {sampler} does not exist: there are {}", samplers.len());
                return Err(ContentError::invalid(at, format!("{problem}; export the file again")));
            }
        }
    }
    Ok(())
}

/// What a scan of a document's JSON finds.
#[derive(Default)]
struct ReferenceScan {
    references: Vec<IndexReference>,
    /// The lengths of the arrays of the root object.
    counts: BTreeMap<String, usize>,
    /// The offset of a value that should be an index and is not.
    broken: Option<usize>,
}

/// Finds all references. The error is the offset of a value that is not an index, if that is the reason.
fn scan(json: &str) -> Result<ReferenceScan, Option<usize>> {
    let mut found = ReferenceScan::default();
    let root = Scan { json, paths: PATHS.to_vec(), depth: 0, array: None, found: &mut found };
    match root.deserialize(&mut serde_json::Deserializer::from_str(json)) {
        Ok(()) => Ok(found),
        Err(_) => Err(found.broken),
    }
}

/// The JSON path of the value at an offset.
fn path_at(json: &str, offset: usize) -> String {
    enum Step {
        Key(String),
        Index(usize),
    }
    let mut steps: Vec<Step> = Vec::new();
    let mut at = 0;
    while let Some(next) = json[at..offset].find(['{', '[', '}', ']', ',', '"']) {
        at += next;
        let mut length = 1;
        match json.as_bytes()[at] {
            b'{' => steps.push(Step::Key(String::new())),
            b'[' => steps.push(Step::Index(0)),
            b'"' => {
                length = string_length(&json[at..]);
                let text = &json[at..at + length];
                let is_key = json[at + length..].trim_start().starts_with(':');
                if let Some(Step::Key(key)) = steps.last_mut().filter(|_| is_key) {
                    *key = serde_json::from_str(text).unwrap_or_default();
                }
            }
            b',' => {
                if let Some(Step::Index(index)) = steps.last_mut() {
                    *index += 1;
                }
            }
            _ => drop(steps.pop()),
        }
        at = (at + length).min(offset);
    }
    let mut path = String::new();
    for step in steps {
        match step {
            Step::Key(key) if path.is_empty() => path = key,
            Step::Key(key) => path += &format!(".{key}"),
            Step::Index(index) => path += &format!("[{index}]"),
        }
    }
    path
}

/// The first extension in `json`, in order of names, that may refer to accessors or buffer views at unknown paths.
pub fn unknown_extension(json: &str) -> Option<String> {
    let is_known = |name: &str| {
        KNOWN_EXTENSIONS.contains(&name) || KNOWN_FAMILIES.iter().any(|family| name.starts_with(family))
    };
    extension_names(json).into_iter().find(|name| !is_known(name))
}

/// The keys of every object called `extensions`, at any depth.
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

/// The length of the JSON string at the beginning of `text`, quotes included.
fn string_length(text: &str) -> usize {
    let mut escaped = false;
    let end = text.bytes().skip(1).position(|byte| {
        let ends = byte == b'"' && !escaped;
        escaped = byte == b'\\' && !escaped;
        ends
    });
    end.map_or(text.len(), |end| end + 2)
}

/// A value on the way to references.
struct Scan<'t, 'f> {
    json: &'t str,
    /// The rest of every path that leads through this value.
    paths: Vec<(ReferenceKind, Path)>,
    depth: usize,
    /// The name of this value, if it is a member of the root object.
    array: Option<String>,
    found: &'f mut ReferenceScan,
}

impl<'t> Scan<'t, '_> {
    /// The value of a member or an element.
    fn step<'n>(&'n mut self, key: &str) -> Scan<'t, 'n> {
        let next = |&(kind, path): &(ReferenceKind, Path)| match path.split_first() {
            Some((first, rest)) if *first == ANY || *first == key => Some((kind, rest)),
            _ => None,
        };
        let paths = self.paths.iter().filter_map(next).collect();
        let array = (self.depth == 0).then(|| key.to_owned());
        Scan { json: self.json, paths, depth: self.depth + 1, array, found: self.found }
    }
}

impl<'t> DeserializeSeed<'t> for Scan<'t, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'t>>(self, deserializer: D) -> Result<(), D::Error> {
        if self.paths.is_empty() && self.array.is_none() {
            return deserializer.deserialize_ignored_any(IgnoredAny).map(drop);
        }
        let Some(&(kind, _)) = self.paths.iter().find(|(_, path)| path.is_empty()) else {
            return deserializer.deserialize_any(self);
        };
        let raw = <&RawValue as Deserialize>::deserialize(deserializer)?.get();
        let range = range_in(self.json, raw);
        match raw.parse() {
            Ok(index) => self.found.references.push(IndexReference { kind, index, range }),
            Err(_) => {
                self.found.broken = Some(range.start);
                return Err(serde::de::Error::custom("not an index"));
            }
        }
        Ok(())
    }
}

impl<'t> Visitor<'t> for Scan<'t, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object or an array")
    }

    fn visit_map<A: MapAccess<'t>>(mut self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<Cow<'t, str>>()? {
            map.next_value_seed(self.step(&key))?;
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'t>>(mut self, mut sequence: A) -> Result<(), A::Error> {
        let mut count = 0;
        while sequence.next_element_seed(self.step(ANY))?.is_some() {
            count += 1;
        }
        if let Some(array) = self.array {
            self.found.counts.insert(array, count);
        }
        Ok(())
    }

    fn visit_bool<E>(self, _: bool) -> Result<(), E> {
        Ok(())
    }

    fn visit_i64<E>(self, _: i64) -> Result<(), E> {
        Ok(())
    }

    fn visit_u64<E>(self, _: u64) -> Result<(), E> {
        Ok(())
    }

    fn visit_f64<E>(self, _: f64) -> Result<(), E> {
        Ok(())
    }

    fn visit_str<E>(self, _: &str) -> Result<(), E> {
        Ok(())
    }

    fn visit_unit<E>(self) -> Result<(), E> {
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
            assert_eq!(json[reference.range.clone()], reference.index.to_string());
        }
        let of = |kind: ReferenceKind| {
            let of_kind = found.iter().filter(|reference| reference.kind == kind);
            of_kind.map(|reference| reference.index).collect::<Vec<_>>()
        };
        assert_eq!(of(ReferenceKind::Accessor), [12, 0, 7, 2]);
        assert_eq!((of(ReferenceKind::ViewOfAccessor), of(ReferenceKind::View)), (vec![3], vec![4]));
        assert_eq!(references(r#"{"skins": [{"inverseBindMatrices": -1}]}"#), None);
        assert_eq!(references(r#"{"skins": 5}"#), Some(Vec::new()));
    }

    /// The sentence of the first broken reference.
    fn problem(json: &str) -> Option<String> {
        check(json).err().map(|error| error.in_file("x").to_string())
    }

    #[test]
    fn references_to_nothing_are_errors_with_their_path() {
        let dangling = r#"{"accessors": [{}, {}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}},
            {"attributes": {"POSITION" : 1, "TEXCOORD_0": 2}}]}]}"#;
        let expected = "x: meshes[0].primitives[1].attributes.TEXCOORD_0: accessor 2 does not exist: there are 2; export the file again";
        assert_eq!(problem(dangling).as_deref(), Some(expected));
        for (json, expected) in [
            (
                r#"{"nodes": [{"children": [0, 1]}]}"#,
                "nodes[0].children[1]: node 1 does not exist: there are 1",
            ),
            (r#"{"scenes": [{}], "scene": 1}"#, "scene: scene 1 does not exist: there are 1"),
            (r#"{"textures": [{"source": -1}]}"#, "textures[0].source: is not an index"),
            (
                r#"{"bufferViews": [{"buffer": 0}]}"#,
                "bufferViews[0].buffer: buffer 0 does not exist: there are 0",
            ),
            (
                r#"{"animations": [{"channels": [{"sampler": 1}], "samplers": [{}]}]}"#,
                "animations[0].channels[0].sampler: sampler 1 does not exist: there are 1",
            ),
        ] {
            assert!(problem(json).is_some_and(|problem| problem.contains(expected)), "{:?}", problem(json));
        }
        let fine = r#"{"scene": 0, "nodes": [{"mesh": 0, "name": "a,b"}], "meshes": [{}], "extras": {"nodes": [7]}}"#;
        assert_eq!(problem(fine), None);
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

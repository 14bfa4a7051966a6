//! Finds and checks the references in a document's JSON: indices into its arrays, such as the accessor of an
//! attribute.

use std::collections::BTreeSet;

use crate::json::Value;

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

/// The paths of references in glTF 2.0 and in the extensions of [`KNOWN_EXTENSIONS`]: keys from the root to a
/// number. `*` stands for every key and every index.
const PATHS: &[(ReferenceKind, &str)] = &[
    (ReferenceKind::Accessor, "meshes.*.primitives.*.attributes.*"),
    (ReferenceKind::Accessor, "meshes.*.primitives.*.indices"),
    (ReferenceKind::Accessor, "meshes.*.primitives.*.targets.*.*"),
    (ReferenceKind::Accessor, "meshes.*.primitives.*.extensions.CESIUM_primitive_outline.indices"),
    (ReferenceKind::Accessor, "skins.*.inverseBindMatrices"),
    (ReferenceKind::Accessor, "animations.*.samplers.*.input"),
    (ReferenceKind::Accessor, "animations.*.samplers.*.output"),
    (ReferenceKind::Accessor, "nodes.*.extensions.EXT_mesh_gpu_instancing.attributes.*"),
    (ReferenceKind::ViewOfAccessor, "accessors.*.bufferView"),
    (ReferenceKind::ViewOfAccessor, "accessors.*.sparse.indices.bufferView"),
    (ReferenceKind::ViewOfAccessor, "accessors.*.sparse.values.bufferView"),
    (ReferenceKind::View, "images.*.bufferView"),
    (ReferenceKind::View, "meshes.*.primitives.*.extensions.KHR_draco_mesh_compression.bufferView"),
    (ReferenceKind::View, "extensions.KHR_audio_emitter.audio.*.bufferView"),
    (ReferenceKind::View, "extensions.EXT_structural_metadata.propertyTables.*.properties.*.values"),
    (ReferenceKind::View, "extensions.EXT_structural_metadata.propertyTables.*.properties.*.arrayOffsets"),
    (ReferenceKind::View, "extensions.EXT_structural_metadata.propertyTables.*.properties.*.stringOffsets"),
    (ReferenceKind::Buffer, "bufferViews.*.buffer"),
    (ReferenceKind::Buffer, "bufferViews.*.extensions.EXT_meshopt_compression.buffer"),
    (ReferenceKind::Buffer, "bufferViews.*.extensions.KHR_meshopt_compression.buffer"),
    (ReferenceKind::Camera, "nodes.*.camera"),
    (ReferenceKind::Image, "textures.*.source"),
    (ReferenceKind::Material, "meshes.*.primitives.*.material"),
    (ReferenceKind::Material, "meshes.*.primitives.*.extensions.KHR_materials_variants.mappings.*.material"),
    (ReferenceKind::Mesh, "nodes.*.mesh"),
    (ReferenceKind::Node, "nodes.*.children.*"),
    (ReferenceKind::Node, "scenes.*.nodes.*"),
    (ReferenceKind::Node, "skins.*.joints.*"),
    (ReferenceKind::Node, "skins.*.skeleton"),
    (ReferenceKind::Node, "animations.*.channels.*.target.node"),
    (ReferenceKind::Sampler, "textures.*.sampler"),
    (ReferenceKind::Scene, "scene"),
    (ReferenceKind::Skin, "nodes.*.skin"),
    (ReferenceKind::Texture, "materials.*.pbrMetallicRoughness.baseColorTexture.index"),
    (ReferenceKind::Texture, "materials.*.pbrMetallicRoughness.metallicRoughnessTexture.index"),
    (ReferenceKind::Texture, "materials.*.normalTexture.index"),
    (ReferenceKind::Texture, "materials.*.occlusionTexture.index"),
    (ReferenceKind::Texture, "materials.*.emissiveTexture.index"),
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

/// A reference of a document: an index into one of its arrays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reference {
    pub kind: ReferenceKind,
    pub index: usize,
}

/// All references of a document.
pub fn references(json: &Value) -> Vec<Reference> {
    let mut found = Vec::new();
    visit(json, &PathTree::new(), &mut Vec::new(), &mut |kind, value, _| {
        found.extend(index(value).map(|index| Reference { kind, index }));
    });
    found
}

/// Replaces the index of every reference.
pub fn renumber(json: &mut Value, new: impl Fn(Reference) -> usize) {
    visit_mut(json, &PathTree::new(), &mut |kind, value| {
        let old = index(value);
        if let Some((old, new)) = old.map(|index| (index, new(Reference { kind, index })))
            && old != new
        {
            *value = new.into();
        }
    });
}

/// All references of a document as it was read. Errors: one of them does not refer to an element that exists.
pub fn check(json: &Value) -> Result<Vec<Reference>, ContentError> {
    let (mut found, mut broken) = (Vec::new(), None);
    visit(json, &PathTree::new(), &mut Vec::new(), &mut |kind, value, steps| {
        let (array, element) = kind.array();
        let (count, index) = (length(&json[array]), index(value));
        found.extend(index.map(|index| Reference { kind, index }));
        // A default scene without scenes is harmless: everything is shown.
        let exists = index.is_some_and(|index| index < count || (kind, count) == (ReferenceKind::Scene, 0));
        if !exists && broken.is_none() {
            let problem = match index {
                Some(index) => format!("{element} {index} does not exist: there are {count}"),
                None => "is not an index".to_owned(),
            };
            broken = Some((path_of(steps), format!("{problem}; export the file again")));
        }
    });
    if let Some((at, problem)) = broken {
        return Err(ContentError::invalid(at, problem));
    }
    check_animations(json)?;
    Ok(found)
}

/// Checks the references of animation channels to the samplers of their own animation.
fn check_animations(json: &Value) -> Result<(), ContentError> {
    for (i, animation) in json["animations"].as_array().into_iter().flatten().enumerate() {
        let count = length(&animation["samplers"]);
        for (k, channel) in animation["channels"].as_array().into_iter().flatten().enumerate() {
            let problem = match index(&channel["sampler"]) {
                Some(sampler) if sampler < count => continue,
                Some(sampler) => format!("sampler {sampler} does not exist: there are {count}"),
                None => "is not an index".to_owned(),
            };
            let at = format!("animations[{i}].channels[{k}].sampler");
            return Err(ContentError::invalid(at, format!("{problem}; export the file again")));
        }
    }
    Ok(())
}

/// The accessors and buffer views that nothing in the input refers to, in ascending order.
#[derive(Debug, Default)]
pub struct Unreferenced {
    pub accessors: Vec<usize>,
    pub views: Vec<usize>,
}

impl Unreferenced {
    /// The unreferenced elements of a document as it was read. `references`: all that it has.
    pub fn new(json: &Value, references: &[Reference]) -> Self {
        let rest = |array: &str, kinds: &[ReferenceKind]| {
            let count = json[array].as_array().map_or(0, Vec::len);
            let is_used = marked(count, references, kinds);
            (0..count).filter(|&index| !is_used[index]).collect()
        };
        Self {
            accessors: rest("accessors", &[ReferenceKind::Accessor]),
            views: rest("bufferViews", &[ReferenceKind::View, ReferenceKind::ViewOfAccessor]),
        }
    }
}

/// Whether each of `count` elements has a reference of one of some kinds.
pub fn marked(count: usize, references: &[Reference], kinds: &[ReferenceKind]) -> Vec<bool> {
    let mut is_marked = vec![false; count];
    for Reference { kind, index } in references {
        if let Some(is_marked) = is_marked.get_mut(*index).filter(|_| kinds.contains(kind)) {
            *is_marked = true;
        }
    }
    is_marked
}

/// A value as an index; none if it is not one.
fn index(value: &Value) -> Option<usize> {
    value.as_u64().and_then(|index| usize::try_from(index).ok())
}

fn length(array: &Value) -> usize {
    array.as_array().map_or(0, Vec::len)
}

/// A step from a value to a part of it.
enum Step<'a> {
    Key(&'a str),
    Index(usize),
}

/// [`PATHS`] as a tree, so that a document is walked once for all of them.
#[derive(Default)]
struct PathTree {
    /// What a value at the end of a path refers to.
    kind: Option<ReferenceKind>,
    branches: Vec<(&'static str, PathTree)>,
}

impl PathTree {
    fn new() -> Self {
        let mut root = Self::default();
        for &(kind, path) in PATHS {
            path.split('.').fold(&mut root, Self::branch).kind = Some(kind);
        }
        root
    }

    /// The branch of a key, which is added if it does not exist.
    fn branch(&mut self, key: &'static str) -> &mut Self {
        let known = self.branches.iter().position(|(known, _)| *known == key);
        let place = known.unwrap_or_else(|| {
            self.branches.push((key, Self::default()));
            self.branches.len() - 1
        });
        &mut self.branches[place].1
    }

    /// The branch for a member of an object.
    fn member(&self, key: &str) -> Option<&Self> {
        self.branches.iter().find(|(name, _)| *name == "*" || *name == key).map(|(_, branch)| branch)
    }

    /// The branch for the elements of an array.
    fn element(&self) -> Option<&Self> {
        self.branches.iter().find(|(name, _)| *name == "*").map(|(_, branch)| branch)
    }
}

/// Calls a function for every value at the end of a path, in the order of the document, with the steps to it.
fn visit<'a>(
    value: &'a Value,
    paths: &PathTree,
    steps: &mut Vec<Step<'a>>,
    call: &mut dyn FnMut(ReferenceKind, &'a Value, &[Step<'a>]),
) {
    if let Some(kind) = paths.kind {
        call(kind, value, steps);
    }
    let mut step = |step: Step<'a>, value: &'a Value, branch: &PathTree| {
        steps.push(step);
        visit(value, branch, steps, call);
        steps.pop();
    };
    match (value, paths.element()) {
        (Value::Object(members), _) => {
            for (key, value) in members {
                if let Some(branch) = paths.member(key) {
                    step(Step::Key(key), value, branch);
                }
            }
        }
        (Value::Array(elements), Some(branch)) => {
            elements.iter().enumerate().for_each(|(i, value)| step(Step::Index(i), value, branch));
        }
        _ => {}
    }
}

/// Calls a function for every value at the end of a path.
fn visit_mut(value: &mut Value, paths: &PathTree, call: &mut dyn FnMut(ReferenceKind, &mut Value)) {
    if let Some(kind) = paths.kind {
        call(kind, value);
    }
    match (value, paths.element()) {
        (Value::Object(members), _) => {
            for (key, value) in members {
                if let Some(branch) = paths.member(key) {
                    visit_mut(value, branch, call);
                }
            }
        }
        (Value::Array(elements), Some(branch)) => {
            elements.iter_mut().for_each(|value| visit_mut(value, branch, call));
        }
        _ => {}
    }
}

/// The JSON path of steps from the root.
fn path_of(steps: &[Step<'_>]) -> String {
    let mut path = String::new();
    for step in steps {
        match step {
            Step::Key(key) if path.is_empty() => path += key,
            Step::Key(key) => path += &format!(".{key}"),
            Step::Index(index) => path += &format!("[{index}]"),
        }
    }
    path
}

/// The first extension of a document, in order of names, that may refer to accessors or buffer views at
/// unknown paths.
pub fn unknown_extension(json: &Value) -> Option<&str> {
    let is_known = |name: &str| {
        KNOWN_EXTENSIONS.contains(&name) || KNOWN_FAMILIES.iter().any(|family| name.starts_with(family))
    };
    let mut names = BTreeSet::new();
    extension_names(json, &mut names);
    names.into_iter().find(|name| !is_known(name))
}

/// Adds the keys of every object called `extensions`, at any depth.
fn extension_names<'a>(value: &'a Value, names: &mut BTreeSet<&'a str>) {
    match value {
        Value::Object(members) => {
            for (key, value) in members.iter().filter(|(_, value)| value.is_object() || value.is_array()) {
                if let ("extensions", Value::Object(extensions)) = (key.as_str(), value) {
                    names.extend(extensions.keys());
                }
                extension_names(value, names);
            }
        }
        Value::Array(elements) => elements.iter().for_each(|element| extension_names(element, names)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::json::parse_test as parse;

    #[test]
    fn references_are_found_where_gltf_has_them() {
        let json = r#"{"skins": [{"inverseBindMatrices" : 12}], "extras": {"skins": [{"inverseBindMatrices": 1}]},
            "accessors": [{"bufferView": 3, "count": 5}], "images": [{"uri": "a"}, {"bufferView":4}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "_\u0041": 7}, "targets": [{"NORMAL": 2}]}]}]}"#;
        let mut json = parse(json).unwrap();
        let found = references(&json);
        let of = |kind: ReferenceKind| {
            let of_kind = found.iter().filter(|reference| reference.kind == kind);
            of_kind.map(|reference| reference.index).collect::<Vec<_>>()
        };
        assert_eq!(of(ReferenceKind::Accessor), [12, 0, 7, 2]);
        assert_eq!((of(ReferenceKind::ViewOfAccessor), of(ReferenceKind::View)), (vec![3], vec![4]));
        renumber(&mut json, |reference| reference.index + 1);
        assert_eq!(json["skins"][0]["inverseBindMatrices"], 13);
        assert_eq!(json["extras"]["skins"][0]["inverseBindMatrices"], 1);
        assert_eq!(references(&parse(r#"{"skins": 5}"#).unwrap()), []);
    }

    /// The sentence of the first broken reference.
    fn problem(json: &str) -> Option<String> {
        check(&parse(json).unwrap()).err().map(|error| error.in_file("x").to_string())
    }

    #[test]
    fn references_to_nothing_are_errors_with_their_path() {
        let dangling = r#"{"accessors": [{}, {}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}},
            {"attributes": {"POSITION" : 1, "TEXCOORD_0": 2}}]}]}"#;
        let expected = "x: meshes[0].primitives[1].attributes.TEXCOORD_0: accessor 2 does not exist: there \
             are 2; export the file again";
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
        assert_eq!(unknown_extension(&parse(known).unwrap()), None);
        for json in [
            r#"{"nodes": [{"extensions" : {"KHR_xmp": {"a": [1, {}]}, "VENDOR_\u0061": {}}}]}"#,
            r#"{"extensions": {"KHR_xmp": {"extensions": {"VENDOR_a": 1}}}}"#,
        ] {
            assert_eq!(unknown_extension(&parse(json).unwrap()), Some("VENDOR_a"), "{json}");
        }
    }
}

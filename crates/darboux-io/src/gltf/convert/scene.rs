//! Converts nodes, skins, instances and animations to other axes.

use std::collections::{BTreeMap, HashMap};

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::value::RawValue;

use super::attributes::floats;
use super::axes::AxisChange;
use crate::Error;
use crate::error::ContentError;
use crate::gltf::json_text::{edit_array, member, set_member};
use crate::gltf::primitives::canonical::CanonicalAccessors;
use crate::gltf::primitives::limits;
use crate::gltf::{Document, ElementType, NewAccessor, Target};

/// Converts the transforms of a scene.
pub struct SceneConverter<'a> {
    accessors: &'a CanonicalAccessors,
    change: AxisChange,
    /// New accessors, by the old one and its kind.
    made: HashMap<(usize, TransformKind), usize>,
}

/// The kind of a transform.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum TransformKind {
    Translation,
    Rotation,
    Scale,
    Matrix,
}

impl TransformKind {
    fn of(name: &str) -> Option<Self> {
        match name {
            "translation" | "TRANSLATION" => Some(Self::Translation),
            "rotation" | "ROTATION" => Some(Self::Rotation),
            "scale" | "SCALE" => Some(Self::Scale),
            _ => None,
        }
    }
}

impl<'a> SceneConverter<'a> {
    pub fn new(accessors: &'a CanonicalAccessors, change: AxisChange) -> Self {
        Self { accessors, change, made: HashMap::new() }
    }

    /// Converts all transforms. Returns whether anything changed. Errors: invalid JSON; animations of properties other than transforms
    /// (`KHR_animation_pointer`).
    pub fn convert(&mut self, document: &mut Document) -> Result<bool, Error> {
        let nodes = self.each(document, "nodes", Self::node)?;
        let skins = self.each(document, "skins", Self::skin)?;
        let animations = self.each(document, "animations", Self::animation)?;
        Ok(nodes || skins || animations)
    }

    /// Edits every element of an array of the root object, on top of earlier edits. Returns whether one changed.
    fn each(
        &mut self,
        document: &mut Document,
        key: &'static str,
        edit: fn(&mut Self, &mut Document, &str, &str) -> Result<String, Error>,
    ) -> Result<bool, Error> {
        let array = member(document.text(), key).ok().flatten().unwrap_or("[]");
        let stored: Vec<Box<RawValue>> = parsed(document, key, array)?;
        let mut edits = document.edits.scene.remove(key).unwrap_or_default();
        let mut has_changed = false;
        for (index, stored) in stored.iter().enumerate() {
            let text = edits.get(&index).map_or(stored.get(), String::as_str);
            let new = edit(self, document, &format!("{key}[{index}]"), text)?;
            if new != text {
                edits.insert(index, new);
                has_changed = true;
            }
        }
        if !edits.is_empty() {
            document.edits.scene.insert(key, edits);
        }
        Ok(has_changed)
    }

    fn node(&mut self, document: &mut Document, at: &str, text: &str) -> Result<String, Error> {
        let change = self.change;
        let mut new = text.to_owned();
        edit_numbers(document, at, &mut new, "matrix", |matrix| change.matrix::<f64>(matrix))?;
        edit_numbers(document, at, &mut new, "translation", |vector| change.vector::<f64>(vector))?;
        edit_numbers(document, at, &mut new, "rotation", |rotation| change.rotation::<f64>(rotation))?;
        edit_numbers(document, at, &mut new, "scale", |scale| change.scale::<f64>(scale))?;
        self.instances(document, at, new)
    }

    /// Converts the transforms of `EXT_mesh_gpu_instancing`.
    fn instances(&mut self, document: &mut Document, at: &str, node: String) -> Result<String, Error> {
        const PATH: [&str; 3] = ["extensions", "EXT_mesh_gpu_instancing", "attributes"];
        let Some(attributes) = nested(&node, &PATH) else { return Ok(node) };
        let at = format!("{at}.{}", PATH.join("."));
        let known: BTreeMap<String, usize> = parsed(document, &at, attributes)?;
        let mut new = attributes.to_owned();
        for (name, accessor) in known {
            if let Some(kind) = TransformKind::of(&name) {
                let accessor = self.accessor(document, accessor, kind)?;
                new = edited(document, &at, set_member(&new, &name, Some(&accessor.to_string())))?;
            }
        }
        edited(document, &at, set_nested(&node, &PATH, &new))
    }

    fn skin(&mut self, document: &mut Document, at: &str, text: &str) -> Result<String, Error> {
        const KEY: &str = "inverseBindMatrices";
        let at = format!("{at}.{KEY}");
        let Some(accessor) = member(text, KEY).ok().flatten() else { return Ok(text.to_owned()) };
        let old = parsed(document, &at, accessor)?;
        let new = self.accessor(document, old, TransformKind::Matrix)?;
        edited(document, &at, set_member(text, KEY, Some(&new.to_string())))
    }

    fn animation(&mut self, document: &mut Document, at: &str, text: &str) -> Result<String, Error> {
        let animation: Animation = parsed(document, at, text)?;
        let array = member(text, "samplers").ok().flatten().unwrap_or("[]");
        let samplers: Vec<Box<RawValue>> = parsed(document, at, array)?;
        let mut kinds: BTreeMap<usize, Option<TransformKind>> = BTreeMap::new();
        for (index, Channel { sampler, target }) in animation.channels.iter().enumerate() {
            let at = format!("{at}.channels[{index}]");
            let unsupported =
                |problem: &str| Err(ContentError::unsupported(&at, problem).in_file(document.name()));
            if !["translation", "rotation", "scale", "weights"].contains(&target.path.as_str()) {
                return unsupported(
                    "animates a property that cannot be converted to other axes; remove the channel",
                );
            }
            let kind = TransformKind::of(&target.path);
            if kinds.insert(*sampler, kind).is_some_and(|other| other != kind) {
                return unsupported(
                    "shares its sampler with a channel of another kind; export the file again",
                );
            }
        }
        let mut new = BTreeMap::new();
        for (index, kind) in kinds {
            let (Some(sampler), Some(kind)) = (samplers.get(index), kind) else { continue };
            let at = format!("{at}.samplers[{index}]");
            let AnimationSampler { output } = parsed(document, &at, sampler.get())?;
            let output = self.accessor(document, output, kind)?.to_string();
            new.insert(index, edited(document, &at, set_member(sampler.get(), "output", Some(&output)))?);
        }
        if new.is_empty() {
            return Ok(text.to_owned());
        }
        let array = edited(document, at, edit_array(array, &new, &[]))?;
        edited(document, at, set_member(text, "samplers", Some(&array)))
    }

    fn accessor(&mut self, document: &mut Document, old: usize, kind: TransformKind) -> Result<usize, Error> {
        let key = (self.accessors.of(old), kind);
        if let Some(&made) = self.made.get(&key) {
            return Ok(made);
        }
        let change = self.change;
        let elements = match kind {
            TransformKind::Translation => {
                floats(ElementType::Vec3, &document.vectors(old)?, |v| change.vector::<f32>(v))
            }
            TransformKind::Rotation => {
                floats(ElementType::Vec4, &document.vectors(old)?, |q| change.rotation::<f32>(q))
            }
            TransformKind::Scale => {
                floats(ElementType::Vec3, &document.vectors(old)?, |s| change.scale::<f32>(s))
            }
            TransformKind::Matrix => {
                floats(ElementType::Mat4, &document.vectors(old)?, |m| change.matrix::<f32>(m))
            }
        };
        let new = NewAccessor::new(elements, Target::Other).with_metadata_of(Some(old));
        let made = document.push_accessor(new);
        limits::check_output(document)?;
        self.made.insert(key, made);
        Ok(made)
    }
}

#[derive(Deserialize)]
struct Animation {
    #[serde(default)]
    channels: Vec<Channel>,
}

#[derive(Deserialize)]
struct Channel {
    sampler: usize,
    target: ChannelTarget,
}

#[derive(Deserialize)]
struct ChannelTarget {
    path: String,
}

#[derive(Deserialize)]
struct AnimationSampler {
    output: usize,
}

/// Changes a member that is an array of `N` numbers, if the object has it.
fn edit_numbers<const N: usize>(
    document: &Document,
    at: &str,
    object: &mut String,
    key: &str,
    change: impl Fn([f64; N]) -> [f64; N],
) -> Result<(), Error> {
    let at = format!("{at}.{key}");
    let Some(text) = member(object, key).ok().flatten() else { return Ok(()) };
    let numbers: Vec<f64> = parsed(document, &at, text)?;
    let numbers: [f64; N] = numbers.try_into().map_err(|numbers: Vec<f64>| {
        document.invalid(&at, format!("has {} numbers instead of {N}; export the file again", numbers.len()))
    })?;
    let new = change(numbers);
    if new != numbers {
        let new = serde_json::to_string(new.as_slice());
        *object = edited(document, &at, new.and_then(|new| set_member(object, key, Some(&new))))?;
    }
    Ok(())
}

/// The text of the value at a path of members, if there is one.
fn nested<'a>(object: &'a str, path: &[&str]) -> Option<&'a str> {
    path.iter().try_fold(object, |object, key| member(object, key).ok()?)
}

fn set_nested(object: &str, path: &[&str], value: &str) -> serde_json::Result<String> {
    match path {
        [] => Ok(value.to_owned()),
        [key, rest @ ..] => {
            let inner = set_nested(member(object, key)?.unwrap_or("{}"), rest, value)?;
            set_member(object, key, Some(&inner))
        }
    }
}

fn parsed<T: DeserializeOwned>(document: &Document, at: &str, text: &str) -> Result<T, Error> {
    serde_json::from_str(text)
        .map_err(|error| document.invalid(at, format!("{error}; export the file again")))
}

fn edited(document: &Document, at: &str, text: serde_json::Result<String>) -> Result<String, Error> {
    text.map_err(|error| document.invalid(at, format!("cannot be edited: {error}; export the file again")))
}

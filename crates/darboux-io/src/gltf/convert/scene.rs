//! Converts nodes, skins, instances and animations to other axes.

use std::collections::{BTreeMap, HashMap};

use crate::json::{self, Value};
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::attributes::floats;
use super::axes::AxisChange;
use crate::Error;
use crate::error::ContentError;
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

    /// Converts all transforms. Returns whether anything changed. Errors: invalid JSON; animations of
    /// properties other than transforms (`KHR_animation_pointer`).
    pub fn convert(&mut self, document: &mut Document) -> Result<bool, Error> {
        let nodes = self.each(document, "nodes", Self::node)?;
        let skins = self.each(document, "skins", Self::skin)?;
        let animations = self.each(document, "animations", Self::animation)?;
        Ok(nodes || skins || animations)
    }

    /// Edits every element of an array of the root object. Returns whether one changed.
    fn each(
        &mut self,
        document: &mut Document,
        array: &'static str,
        edit: fn(&mut Self, &mut Document, &str, &mut Value) -> Result<(), Error>,
    ) -> Result<bool, Error> {
        let count = document.json[array].as_array().map_or(0, Vec::len);
        let mut has_changed = false;
        for index in 0..count {
            let mut element = document.element(array, index).clone();
            edit(self, document, &format!("{array}[{index}]"), &mut element)?;
            let changed = document.edit_element(array, index, |stored| *stored = element);
            has_changed |= changed.map_err(|error| error.in_file(document.name()))?;
        }
        Ok(has_changed)
    }

    fn node(&mut self, document: &mut Document, at: &str, node: &mut Value) -> Result<(), Error> {
        let change = self.change;
        edit_numbers(document, at, node, "matrix", |matrix| change.matrix::<f64>(matrix))?;
        edit_numbers(document, at, node, "translation", |vector| change.vector::<f64>(vector))?;
        edit_numbers(document, at, node, "rotation", |rotation| change.rotation::<f64>(rotation))?;
        edit_numbers(document, at, node, "scale", |scale| change.scale::<f64>(scale))?;
        self.instances(document, at, node)
    }

    /// Converts the transforms of `EXT_mesh_gpu_instancing`.
    fn instances(&mut self, document: &mut Document, at: &str, node: &mut Value) -> Result<(), Error> {
        const PATH: [&str; 3] = ["extensions", "EXT_mesh_gpu_instancing", "attributes"];
        let attributes = PATH.into_iter().try_fold(node, |value, key| value.get_mut(key));
        let Some(Value::Object(attributes)) = attributes else { return Ok(()) };
        for (name, accessor) in attributes {
            if let Some(kind) = TransformKind::of(name) {
                let at = format!("{at}.extensions.EXT_mesh_gpu_instancing.attributes.{name}");
                self.reference(document, &at, accessor, kind)?;
            }
        }
        Ok(())
    }

    fn skin(&mut self, document: &mut Document, at: &str, skin: &mut Value) -> Result<(), Error> {
        const KEY: &str = "inverseBindMatrices";
        match skin.get_mut(KEY) {
            Some(accessor) => {
                self.reference(document, &format!("{at}.{KEY}"), accessor, TransformKind::Matrix)
            }
            None => Ok(()),
        }
    }

    fn animation(&mut self, document: &mut Document, at: &str, animation: &mut Value) -> Result<(), Error> {
        let parsed: Animation = read(document, at, animation)?;
        let mut kinds: BTreeMap<usize, Option<TransformKind>> = BTreeMap::new();
        for (index, Channel { sampler, target }) in parsed.channels.iter().enumerate() {
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
        for (index, kind) in kinds {
            let sampler = animation.get_mut("samplers").and_then(|samplers| samplers.get_mut(index));
            let (Some(sampler), Some(kind)) = (sampler, kind) else { continue };
            let at = format!("{at}.samplers[{index}].output");
            let Some(output) = sampler.get_mut("output") else {
                return Err(document.invalid(at, "is missing; export the file again"));
            };
            self.reference(document, &at, output, kind)?;
        }
        Ok(())
    }

    /// Replaces the index of an accessor by the index of the converted accessor.
    fn reference(
        &mut self,
        document: &mut Document,
        at: &str,
        accessor: &mut Value,
        kind: TransformKind,
    ) -> Result<(), Error> {
        let old = read(document, at, accessor)?;
        *accessor = self.accessor(document, old, kind)?.into();
        Ok(())
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

/// Changes a member that is an array of `N` numbers, if the object has it.
fn edit_numbers<const N: usize>(
    document: &Document,
    at: &str,
    object: &mut Value,
    key: &str,
    change: impl Fn([f64; N]) -> [f64; N],
) -> Result<(), Error> {
    let Some(member) = object.get_mut(key) else { return Ok(()) };
    let at = format!("{at}.{key}");
    let numbers: Vec<f64> = read(document, &at, member)?;
    let numbers: [f64; N] = numbers.try_into().map_err(|numbers: Vec<f64>| {
        document.invalid(&at, format!("has {} numbers instead of {N}; export the file again", numbers.len()))
    })?;
    let new = change(numbers);
    if new != numbers {
        *member = new.to_vec().into();
    }
    Ok(())
}

fn read<T: DeserializeOwned>(document: &Document, at: &str, value: &Value) -> Result<T, Error> {
    json::read(value, at).map_err(|error| error.in_file(document.name()))
}

//! The mark of a convention in `asset.extras`, and warnings about data that a conversion does not change.

use std::collections::{BTreeMap, BTreeSet};

use crate::json::{Map, Value};
use darboux::Convention;
use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::Error;
use crate::gltf::Document;
use crate::gltf::schema::Material;

/// The member of `asset.extras` with the name of a convention.
const MEMBER: &str = "darboux_convention";

impl Document {
    /// The convention of the vertex data: glTF's, unless [`convert_vertices`](crate::gltf::convert_vertices)
    /// has marked another one in `asset.extras.darboux_convention`. Errors: the mark is not a convention.
    pub fn convention(&self) -> Result<Convention, Error> {
        Ok(self.noted_convention()?.unwrap_or(Convention::GLTF))
    }

    fn noted_convention(&self) -> Result<Option<Convention>, Error> {
        let Some(note) = self.note() else { return Ok(None) };
        let convention = note
            .as_str()
            .ok_or_else(|| format!("{note} is not a string"))
            .and_then(|name| name.parse().map_err(|error: darboux::ConventionError| error.to_string()));
        let advice = "a newer version may support it; remove the member if it is wrong";
        let named = |problem| self.invalid(format!("asset.extras.{MEMBER}"), format!("{problem}; {advice}"));
        convention.map(Some).map_err(named)
    }

    fn note(&self) -> Option<&Value> {
        self.json["asset"]["extras"].get(MEMBER)
    }

    /// Whether the document is marked with a convention.
    pub(super) fn has_note(&self) -> bool {
        self.note().is_some()
    }

    /// Checks that the document is not marked with another convention.
    pub(super) fn check_convention(&self, from: Convention) -> Result<(), Error> {
        match self.noted_convention()? {
            Some(noted) if noted != from => {
                let problem = format!("is \"{noted}\"; convert from that convention");
                Err(self.invalid(format!("asset.extras.{MEMBER}"), problem))
            }
            _ => Ok(()),
        }
    }

    /// Marks the document with a convention, or removes the mark for glTF's. Errors: `asset.extras` is not an
    /// object.
    pub(super) fn set_convention(&mut self, convention: Convention) -> Result<(), Error> {
        let name = (convention != Convention::GLTF).then(|| Value::from(convention.to_string()));
        if name.as_ref() == self.note() {
            return Ok(());
        }
        let asset = self.json.get_mut("asset").and_then(Value::as_object_mut);
        let extras = asset.map(|asset| {
            let extras = asset.get_or_add("extras");
            if extras.is_null() {
                *extras = Map::default().into();
            }
            extras
        });
        let Some(extras) = extras.and_then(Value::as_object_mut) else {
            let problem = format!("is not an object, so that {MEMBER} cannot be stored; remove it");
            return Err(self.invalid("asset.extras", problem));
        };
        match name {
            Some(name) => drop(extras.insert(MEMBER, name)),
            None => drop(extras.remove(MEMBER)),
        }
        if extras.is_empty() {
            self.json["asset"].as_object_mut().and_then(|asset| asset.remove("extras"));
        }
        self.is_changed = true;
        Ok(())
    }
}

/// The parts of a file that a change of axes does not convert.
#[derive(Deserialize)]
struct SceneParts {
    #[serde(default)]
    nodes: Vec<NodeParts>,
    #[serde(default)]
    extensions: BTreeMap<String, IgnoredAny>,
    #[serde(default, rename = "extensionsUsed")]
    extensions_used: Vec<String>,
}

#[derive(Deserialize)]
struct NodeParts {
    camera: Option<IgnoredAny>,
    #[serde(default)]
    extensions: BTreeMap<String, IgnoredAny>,
}

/// Extensions of nodes or of the file without vectors, or whose vectors are converted or named in other
/// warnings.
const WITHOUT_VECTORS: [&str; 9] = [
    "EXT_instance_features",
    "EXT_mesh_gpu_instancing",
    "EXT_structural_metadata",
    "KHR_lights_punctual",
    "KHR_materials_variants",
    "KHR_node_visibility",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_lod",
];

/// Warnings about data that a change of axes does not convert.
fn axis_warnings(scene: &SceneParts) -> Vec<String> {
    let mut warnings = Vec::new();
    let looks =
        |node: &NodeParts| node.camera.is_some() || node.extensions.contains_key("KHR_lights_punctual");
    if scene.nodes.iter().any(looks) {
        warnings.push("cameras and lights still look along -z of their nodes".to_owned());
    }
    let names = scene.nodes.iter().flat_map(|node| node.extensions.keys()).chain(scene.extensions.keys());
    let names: BTreeSet<&str> =
        names.map(String::as_str).filter(|name| !WITHOUT_VECTORS.contains(name)).collect();
    if !names.is_empty() {
        let names = names.into_iter().collect::<Vec<_>>().join(", ");
        warnings.push(format!("vectors in {names}, if there are any, keep the old axes"));
    }
    warnings
}

/// Warnings about data that must be converted by other means, or checked.
pub fn warnings(document: &Document, from: Convention, to: Convention) -> Vec<String> {
    let mut warnings = Vec::new();
    let conversion = from.to(to);
    if conversion.inverts_red() || conversion.inverts_green() {
        let has_normal_map = |material: &Material| {
            let coat = material.extensions.as_ref().and_then(|extensions| extensions.clearcoat.as_ref());
            material.normal_texture.is_some()
                || coat.is_some_and(|coat| coat.clearcoat_normal_texture.is_some())
        };
        let materials =
            document.stored_materials().iter().enumerate().filter(|(_, material)| has_normal_map(material));
        let names: Vec<String> = materials.map(|(index, _)| format!("materials[{index}]")).collect();
        if !names.is_empty() {
            let names = names.join(", ");
            warnings.push(format!("the normal maps of {names} were not converted; convert these images too"));
        }
    }
    // A file whose scene cannot be parsed is refused by the conversion.
    let Ok(scene) = document.read::<SceneParts>() else { return warnings };
    if from.uv_origin != to.uv_origin
        && scene.extensions_used.iter().any(|name| name == "KHR_texture_transform")
    {
        warnings.push(
            "KHR_texture_transform still counts v from the top; check the materials that use it".to_owned(),
        );
    }
    if from.axes != to.axes {
        warnings.extend(axis_warnings(&scene));
    }
    warnings
}

//! What stands around vertex data: the convention that a file names, nodes that move meshes, materials with normal maps.

use std::collections::BTreeMap;

use darboux::Convention;
use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::Error;
use crate::error::Fault;
use crate::gltf::Document;
use crate::gltf::json::{keys, member, quoted, set_member};
use crate::gltf::schema::Material;

/// Errors: a document that says that it is in another convention.
pub fn check_convention(document: &Document, from: Convention) -> Result<(), Error> {
    match document.convention() {
        Some(named) if preset(&named).is_some_and(|named| named != from) => {
            let problem = format!("says {named:?}; convert it from that");
            Err(document.invalid("asset.extras.darboux_convention", problem))
        }
        _ => Ok(()),
    }
}

/// The preset of a name.
fn preset(name: &str) -> Option<Convention> {
    Convention::PRESETS.iter().find(|(preset, _)| *preset == name).map(|(_, convention)| *convention)
}

/// The name of the first preset that is this convention.
fn name_of(convention: Convention) -> Option<&'static str> {
    Convention::PRESETS.iter().find(|(_, preset)| *preset == convention).map(|(name, _)| *name)
}

/// The member of `asset.extras` that names a convention.
const MEMBER: &str = "darboux_convention";

impl Document {
    /// The convention that vertex data is in, as [`convert_vertices`](crate::gltf::convert_vertices) noted it; none in files that are
    /// in glTF's, as they should be.
    pub fn convention(&self) -> Option<String> {
        let extras = member(self.asset_text()?, "extras").ok()??;
        let name = member(extras, MEMBER).ok()??;
        serde_json::from_str(name).ok()
    }

    /// Notes the convention that vertex data is in, or takes the note out where it is glTF's.
    ///
    /// Errors: `asset.extras` that is no object.
    pub(super) fn set_convention(&mut self, convention: Convention) -> Result<(), Error> {
        let name = name_of(convention).filter(|_| convention != Convention::GLTF);
        if name.is_none() && self.convention().is_none() {
            return Ok(());
        }
        let asset = self.asset_text().unwrap_or("{}").to_owned();
        let noted = (|| {
            let extras = member(&asset, "extras")?.unwrap_or("{}");
            let noted = set_member(extras, MEMBER, name.map(quoted).as_deref())?;
            let noted = (!keys(&noted)?.is_empty()).then_some(noted);
            set_member(&asset, "extras", noted.as_deref())
        })();
        let noted = noted.map_err(|_: serde_json::Error| {
            self.invalid(
                "asset.extras",
                format!("is no object, so that {MEMBER} cannot be noted; take it out"),
            )
        })?;
        if noted != asset {
            self.edits.asset = Some(noted);
        }
        Ok(())
    }

    fn asset_text(&self) -> Option<&str> {
        match &self.edits.asset {
            Some(edited) => Some(edited),
            None => member(self.text(), "asset").ok()?,
        }
    }
}

/// The parts of a scene that say where meshes stand.
#[derive(Deserialize)]
struct Scene {
    #[serde(default)]
    nodes: Vec<Node>,
    #[serde(default)]
    skins: Vec<IgnoredAny>,
    #[serde(default)]
    animations: Vec<IgnoredAny>,
    #[serde(default, rename = "extensionsUsed")]
    extensions_used: Vec<String>,
}

#[derive(Deserialize)]
struct Node {
    matrix: Option<Vec<f64>>,
    translation: Option<Vec<f64>>,
    rotation: Option<Vec<f64>>,
    scale: Option<Vec<f64>>,
    #[serde(default)]
    extensions: BTreeMap<String, IgnoredAny>,
}

impl Node {
    fn moves(&self) -> bool {
        const IDENTITY: [f64; 16] =
            [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let differs =
            |value: &Option<Vec<f64>>, rest: &[f64]| value.as_ref().is_some_and(|value| value != rest);
        differs(&self.matrix, &IDENTITY)
            || differs(&self.translation, &[0.0; 3])
            || differs(&self.rotation, &[0.0, 0.0, 0.0, 1.0])
            || differs(&self.scale, &[1.0; 3])
            || self.extensions.contains_key("EXT_mesh_gpu_instancing")
    }
}

fn scene(document: &Document) -> Result<Scene, Error> {
    serde_json::from_str(document.text())
        .map_err(|error| document.invalid("nodes", format!("{error}; export the file again")))
}

/// Errors: nodes, skins or animations that would go on in the old axes.
pub fn refuse_moved(document: &Document) -> Result<(), Error> {
    let scene = scene(document)?;
    let moving = scene.nodes.iter().position(Node::moves);
    let (at, what) = match (moving, scene.skins.is_empty(), scene.animations.is_empty()) {
        (Some(node), ..) => (format!("nodes[{node}]"), "moves or turns what it holds"),
        (None, false, _) => ("skins[0]".into(), "moves vertices"),
        (None, true, false) => ("animations[0]".into(), "moves nodes"),
        (None, true, true) => return Ok(()),
    };
    let problem = format!(
        "{what}, and would go on in the old axes; apply transforms in a modeller, or choose conventions with the same axes"
    );
    Err(Fault::unsupported(at, problem).in_file(document.name()))
}

/// What must change too, or be looked at.
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
            document.materials().iter().enumerate().filter(|(_, material)| has_normal_map(material));
        let names: Vec<String> = materials.map(|(index, _)| format!("materials[{index}]")).collect();
        if !names.is_empty() {
            let names = names.join(", ");
            warnings.push(format!("the normal maps of {names} are as they were; convert these images too"));
        }
    }
    let transforms = |scene: Scene| scene.extensions_used.iter().any(|name| name == "KHR_texture_transform");
    if from.uv_origin != to.uv_origin && scene(document).is_ok_and(transforms) {
        warnings.push("KHR_texture_transform still counts v from the top; look at its materials".to_owned());
    }
    warnings
}

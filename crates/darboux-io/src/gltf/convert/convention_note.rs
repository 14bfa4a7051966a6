//! What stands around vertex data: the convention that a file names, and what a conversion leaves behind.

use std::collections::{BTreeMap, BTreeSet};

use darboux::Convention;
use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::Error;
use crate::gltf::Document;
use crate::gltf::json_text::{keys, member, quoted, set_member};
use crate::gltf::schema::Material;

/// The member of `asset.extras` that names a convention.
const MEMBER: &str = "darboux_convention";

impl Document {
    /// The convention that vertex data is in: glTF's, as it should be, unless [`convert_vertices`](crate::gltf::convert_vertices) noted
    /// another one in `asset.extras.darboux_convention`. Errors: a note that names none.
    pub fn convention(&self) -> Result<Convention, Error> {
        Ok(self.noted_convention()?.unwrap_or(Convention::GLTF))
    }

    fn noted_convention(&self) -> Result<Option<Convention>, Error> {
        let Some(note) = self.note() else { return Ok(None) };
        let name: Result<String, _> = serde_json::from_str(note);
        let convention = name
            .map_err(|_| format!("{note} is no text"))
            .and_then(|name| name.parse().map_err(|error: darboux::ConventionError| error.to_string()));
        let advice = "a newer version may know it; take the note out if it is wrong";
        let named = |problem| self.invalid(format!("asset.extras.{MEMBER}"), format!("{problem}; {advice}"));
        convention.map(Some).map_err(named)
    }

    fn note(&self) -> Option<&str> {
        member(member(self.asset_text()?, "extras").ok()??, MEMBER).ok()?
    }

    /// Whether it says which convention it is in.
    pub(super) fn has_note(&self) -> bool {
        self.note().is_some()
    }

    /// Errors: a document that says that it is in another convention.
    pub(super) fn check_convention(&self, from: Convention) -> Result<(), Error> {
        match self.noted_convention()? {
            Some(noted) if noted != from => {
                let problem = format!("says \"{noted}\"; convert it from that");
                Err(self.invalid(format!("asset.extras.{MEMBER}"), problem))
            }
            _ => Ok(()),
        }
    }

    /// Notes the convention that vertex data is in, or takes the note out where it is glTF's.
    ///
    /// Errors: `asset.extras` that is no object.
    pub(super) fn set_convention(&mut self, convention: Convention) -> Result<(), Error> {
        let name = (convention != Convention::GLTF).then(|| quoted(&convention.to_string()));
        if name.as_deref() == self.note() {
            return Ok(());
        }
        let asset = self.asset_text().unwrap_or("{}").to_owned();
        let noted = (|| {
            let extras = member(&asset, "extras")?.unwrap_or("{}");
            let noted = set_member(extras, MEMBER, name.as_deref())?;
            let noted = (!keys(&noted)?.is_empty()).then_some(noted);
            set_member(&asset, "extras", noted.as_deref())
        })();
        let noted = noted.map_err(|_: serde_json::Error| {
            self.invalid(
                "asset.extras",
                format!("is no object, so that {MEMBER} cannot be noted; take it out"),
            )
        })?;
        self.edits.asset = Some(noted);
        Ok(())
    }

    fn asset_text(&self) -> Option<&str> {
        match &self.edits.asset {
            Some(edited) => Some(edited),
            None => member(self.text(), "asset").ok()?,
        }
    }
}

/// The parts of a file that other axes leave behind.
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

/// Extensions of nodes or of the file that hold no vectors, or whose vectors are converted or spoken of.
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

/// What a document's other axes leave behind.
fn left_behind(scene: &SceneParts) -> Vec<String> {
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
        warnings.push(format!("vectors in {names}, if there are any, stay in the old axes"));
    }
    warnings
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
    // A file whose scene cannot be read is refused where it is converted.
    let Ok(scene) = serde_json::from_str::<SceneParts>(document.text()) else { return warnings };
    if from.uv_origin != to.uv_origin
        && scene.extensions_used.iter().any(|name| name == "KHR_texture_transform")
    {
        warnings.push("KHR_texture_transform still counts v from the top; look at its materials".to_owned());
    }
    if from.axes != to.axes {
        warnings.extend(left_behind(&scene));
    }
    warnings
}

//! Builds a glTF document from a scene: its faces cut, its corners joined to vertices, everything else as
//! JSON.
//!
//! ```text
//! meshes      primitives by material: faces cut, vertices, accessors
//! materials   materials, textures, images
//! untextured  copies of materials for primitives without UVs
//! nodes       the hierarchy, with a root that turns axes and units; skins
//! data        the binary chunk: buffer views and accessors
//! ```

mod data;
mod materials;
mod meshes;
mod nodes;
mod untextured;

use serde_json::{Value, json};

use super::polygons::Cutter;
use super::provenance::Provenance;
use super::scene::SourceScene;
use super::smoothing;
use crate::LoadOptions;
use crate::error::ContentError;
use data::DataBuilder;

/// A scene as a GLB.
#[derive(Debug)]
pub struct Built {
    /// The GLB, from `start` on.
    pub bytes: Vec<u8>,
    pub start: usize,
    pub provenance: Provenance,
    /// What is wrong, and what was not carried over: one sentence each.
    pub warnings: Vec<String>,
}

/// Builds the document of a scene. `size`: the length of the file, for the memory limit.
///
/// Errors: a scene without faces; indices out of range; more primitives than the memory limit permits; more
/// than the 4 GiB that a GLB can hold.
pub fn build(mut scene: SourceScene, size: usize, options: &LoadOptions) -> Result<Built, ContentError> {
    let mut warnings = std::mem::take(&mut scene.warnings);
    warnings.extend(smoothing::add_normals(&mut scene.meshes).warnings());
    let mut data = DataBuilder::default();
    let mut cutter = Cutter::new(options.polygon_rule);
    let limit = options.budget(size, 0);
    let mut meshes = meshes::build(&scene, &mut cutter, &mut data, limit)?;
    warnings.extend(untextured::replace(&mut scene, &mut meshes.json));
    let materials = materials::build(&scene, &mut data, options, &mut warnings);
    let nodes = nodes::build(&scene, &meshes.of_source, &mut data);
    warnings.extend(meshes.warnings);
    warnings.extend(not_carried_warning(&scene));
    let mut faces = meshes.faces;
    (faces.outside_diagonals, faces.folded) = (cutter.outside_diagonals, cutter.folded);
    let provenance = Provenance {
        format: scene.format,
        generator: scene.generator,
        faces,
        polygon_rule: options.polygon_rule,
        not_carried: scene.not_carried,
        unread_maps: materials.unread_maps,
        companions: Vec::new(),
        primitives: meshes.sources,
    };
    let mut root = json!({
        "asset": {"version": "2.0", "generator": concat!("darboux ", env!("CARGO_PKG_VERSION")), "extras": {"darboux_source": {
            "format": provenance.format.name(),
            "generator": provenance.generator,
        }}},
        "scene": 0,
        "scenes": [{}],
    });
    if !nodes.roots.is_empty() {
        root["scenes"][0]["nodes"] = json!(nodes.roots);
    }
    let lists = [
        ("nodes", nodes.nodes),
        ("meshes", meshes.json),
        ("materials", materials.materials),
        ("textures", materials.textures),
        ("images", materials.images),
        ("samplers", materials.samplers),
        ("skins", nodes.skins),
    ];
    for (name, list) in lists {
        if !list.is_empty() {
            root[name] = list.into();
        }
    }
    let extensions: Vec<Value> = materials.extensions.into_iter().map(Value::from).collect();
    if extensions.iter().any(|extension| extension == materials::WEBP) {
        // No other image stands behind it.
        root["extensionsRequired"] = json!([materials::WEBP]);
    }
    if !extensions.is_empty() {
        root["extensionsUsed"] = extensions.into();
    }
    let (bytes, start) = data.finish(root)?;
    Ok(Built { bytes, start, provenance, warnings })
}

fn not_carried_warning(scene: &SourceScene) -> Option<String> {
    (!scene.not_carried.is_empty()).then(|| format!("not carried over: {}", scene.not_carried.join(", ")))
}

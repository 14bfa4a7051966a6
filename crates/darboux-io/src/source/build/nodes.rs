//! The hierarchy of a document. A root turns axes and units to those of glTF, so that vertices keep their
//! bits.

use darboux::Convention;
use serde_json::{Value, json};

use super::data::DataBuilder;
use crate::source::scene::SourceScene;

/// The lists of nodes and skins, and the roots of the scene.
#[derive(Debug, Default)]
pub struct Nodes {
    pub nodes: Vec<Value>,
    pub roots: Vec<usize>,
    pub skins: Vec<Value>,
}

/// Builds the hierarchy. `mesh_of_source`: the index in the document of each mesh of the scene; none for
/// those without faces.
pub fn build(scene: &SourceScene, mesh_of_source: &[Option<usize>], data: &mut DataBuilder) -> Nodes {
    let mut built = Nodes::default();
    if scene.nodes.is_empty() {
        built.nodes = (0..mesh_of_source.len())
            .filter_map(|source| {
                let name = &scene.meshes[source].name;
                mesh_of_source[source].map(|mesh| json!({"mesh": mesh, "name": name}))
            })
            .collect();
        built.roots = (0..built.nodes.len()).collect();
    } else {
        add_nodes(scene, mesh_of_source, &mut built);
    }
    if let Some(matrix) = root_matrix(scene) {
        built.nodes.push(json!({"name": "axes and units", "matrix": matrix, "children": built.roots}));
        built.roots = vec![built.nodes.len() - 1];
    }
    for skin in &scene.skins {
        let mut json = json!({"name": skin.name, "joints": skin.joints});
        if skin.inverse_bind_matrices.len() == skin.joints.len() {
            json["inverseBindMatrices"] = data.matrices(&skin.inverse_bind_matrices).into();
        }
        built.skins.push(json);
    }
    built
}

fn add_nodes(scene: &SourceScene, mesh_of_source: &[Option<usize>], built: &mut Nodes) {
    let mut children = vec![Vec::new(); scene.nodes.len()];
    for (index, node) in scene.nodes.iter().enumerate() {
        match node.parent.and_then(|parent| children.get_mut(parent)) {
            Some(children) => children.push(index),
            None => built.roots.push(index),
        }
    }
    for (node, children) in scene.nodes.iter().zip(children) {
        let mut json = json!({"name": node.name});
        if let Some(matrix) = node.matrix.filter(|matrix| *matrix != IDENTITY) {
            json["matrix"] = json!(matrix.as_flattened());
        }
        if !children.is_empty() {
            json["children"] = json!(children);
        }
        if let Some(mesh) = node.mesh.and_then(|mesh| *mesh_of_source.get(mesh)?) {
            json["mesh"] = mesh.into();
            if let Some(skin) = node.skin {
                json["skin"] = skin.into();
            }
        }
        built.nodes.push(json);
    }
}

const IDENTITY: [[f64; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// The matrix from the scene's axes and units to those of glTF; none if they are the same.
fn root_matrix(scene: &SourceScene) -> Option<Vec<f64>> {
    let turn = Convention { axes: scene.axes, ..Convention::GLTF }.to(Convention::GLTF);
    let scale = scene.meters_per_unit.unwrap_or(1.0);
    let column = |axis: usize| {
        let mut unit = [0.0; 3];
        unit[axis] = 1.0;
        let [x, y, z] = turn.vector(unit).map(|x| f64::from(x) * scale + 0.0);
        [x, y, z, 0.0]
    };
    let matrix = [column(0), column(1), column(2), IDENTITY[3]];
    (matrix != IDENTITY).then(|| matrix.as_flattened().to_vec())
}

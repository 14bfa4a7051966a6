//! Finds the meshes of the scene with the transforms, morph weights and skins of their nodes.

use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

use serde::Deserialize;

use super::Document;
use super::objects_only::read_from_objects;
use super::primitives::limits;
use super::schema::Attributes;
use crate::Error;
use crate::error::ContentError;

/// A matrix in columns, for column vectors.
type Matrix = [[f64; 4]; 4];

const IDENTITY: Matrix =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// The most places of meshes. Nodes may share instances, so that a small file can ask for any number.
const MAX_MESH_INSTANCES: usize = 1 << 20;

/// The meshes and skins of the scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshInstances {
    /// The meshes of all nodes.
    pub meshes: Vec<MeshInstance>,
    /// The joint matrices of every skin, from the bind pose of the mesh to the scene; empty for unused
    /// skins.
    pub skins: Vec<Vec<[[f64; 4]; 4]>>,
}

/// A mesh of a node.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshInstance {
    /// The index of the mesh.
    pub mesh: usize,
    /// The name of the node, if it has one.
    pub node_name: Option<String>,
    /// The transforms from the mesh to the scene, in columns: one per instance of `EXT_mesh_gpu_instancing`,
    /// otherwise one. The identity for a skinned mesh.
    pub matrices: Vec<[[f64; 4]; 4]>,
    /// The weights of morph targets; empty if all are zero. Nodes without weights of their own share those
    /// of the mesh.
    pub weights: Arc<[f64]>,
    /// The index of the skin that moves its vertices.
    pub skin: Option<usize>,
}

read_from_objects! { Scenes, Scene, Node, NodeExtensions, Instancing, Skin, Weights }

#[derive(Deserialize)]
#[serde(remote = "Self")]
struct Scenes {
    #[serde(default)]
    scene: usize,
    #[serde(default)]
    scenes: Vec<Scene>,
    #[serde(default)]
    nodes: Vec<Node>,
    #[serde(default)]
    meshes: Vec<Weights>,
    #[serde(default)]
    skins: Vec<Skin>,
}

/// The default weights of a mesh's morph targets.
#[derive(Deserialize)]
#[serde(remote = "Self")]
struct Weights {
    #[serde(default)]
    weights: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(remote = "Self")]
struct Scene {
    #[serde(default)]
    nodes: Vec<usize>,
}

#[derive(Deserialize)]
#[serde(remote = "Self")]
struct Node {
    name: Option<String>,
    mesh: Option<usize>,
    skin: Option<usize>,
    weights: Option<Vec<f64>>,
    #[serde(default)]
    extensions: NodeExtensions,
    #[serde(default)]
    children: Vec<usize>,
    matrix: Option<[f64; 16]>,
    #[serde(default)]
    translation: [f64; 3],
    #[serde(default = "no_rotation")]
    rotation: [f64; 4],
    #[serde(default = "no_scale")]
    scale: [f64; 3],
}

#[derive(Default, Deserialize)]
#[serde(remote = "Self")]
struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    instancing: Option<Instancing>,
}

/// The accessors of the instances' translations, rotations and scales.
#[derive(Deserialize)]
#[serde(remote = "Self")]
struct Instancing {
    #[serde(default)]
    attributes: Attributes,
}

#[derive(Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
struct Skin {
    joints: Vec<usize>,
    inverse_bind_matrices: Option<usize>,
}

fn no_rotation() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

fn no_scale() -> [f64; 3] {
    [1.0; 3]
}

impl Document {
    /// The meshes of the default scene, without animation.
    ///
    /// A document without scenes has all nodes in its scene, one without nodes all meshes. Errors: joints
    /// outside the scene, missing matrices, nodes with several parents, more than 2^20 instances.
    pub fn mesh_instances(&self) -> Result<MeshInstances, Error> {
        let scenes: Scenes = self.read().map_err(|error| error.in_file(self.name()))?;
        let nodes = nodes_of_scene(&scenes).map_err(|error| error.in_file(self.name()))?;
        let mut instances = MeshInstances { meshes: Vec::new(), skins: vec![Vec::new(); scenes.skins.len()] };
        let weights: Vec<Arc<[f64]>> =
            scenes.meshes.iter().map(|mesh| shared_weights(&mesh.weights)).collect();
        if scenes.nodes.is_empty() {
            let all = weights.iter().cloned().enumerate();
            instances.meshes.extend(all.map(|(mesh, weights)| MeshInstance {
                mesh,
                node_name: None,
                matrices: vec![IDENTITY],
                weights,
                skin: None,
            }));
        }
        let mut instance_count: usize = 0;
        for &(index, matrix) in &nodes {
            let Some(mesh) = self.mesh_of_node(&scenes, &weights, index, matrix)? else { continue };
            instance_count = instance_count.saturating_add(mesh.matrices.len());
            instances.meshes.push(mesh);
            if instance_count > MAX_MESH_INSTANCES {
                let problem = format!("has more than {MAX_MESH_INSTANCES} instances of meshes; remove some");
                return Err(self.invalid("scene", problem));
            }
        }
        let nodes: HashMap<usize, Matrix> = nodes.into_iter().collect();
        let used: BTreeSet<usize> = instances.meshes.iter().filter_map(|mesh| mesh.skin).collect();
        // Skins with the same matrices follow each other, so that these are read once.
        let mut used: Vec<usize> = used.into_iter().collect();
        used.sort_by_key(|&index| scenes.skins[index].inverse_bind_matrices);
        limits::check_matrices(
            self,
            used.iter().filter_map(|&index| scenes.skins[index].inverse_bind_matrices),
        )?;
        let mut inverses = None;
        for index in used {
            let skin = &scenes.skins[index];
            if let Some(accessor) = skin.inverse_bind_matrices
                && inverses.as_ref().is_none_or(|(read, _)| *read != accessor)
            {
                inverses = Some((accessor, self.vectors::<16>(accessor)?));
            }
            let inverses = inverses.as_ref().filter(|_| skin.inverse_bind_matrices.is_some());
            let inverses = inverses.map(|(_, inverses)| &**inverses);
            instances.skins[index] = self.joints(skin, inverses, &format!("skins[{index}]"), &nodes)?;
        }
        Ok(instances)
    }

    /// The mesh of a node, if it has one, with the node's transform, weights and skin.
    fn mesh_of_node(
        &self,
        scenes: &Scenes,
        weights: &[Arc<[f64]>],
        index: usize,
        matrix: Matrix,
    ) -> Result<Option<MeshInstance>, Error> {
        let node = &scenes.nodes[index];
        let Some(mesh) = node.mesh else { return Ok(None) };
        let at = format!("nodes[{index}]");
        let missing = |what: &str, index: usize, count: usize| {
            let problem = format!("{what} {index} does not exist: there are {count}; export the file again");
            self.invalid(&at, problem)
        };
        let of_mesh = weights.get(mesh).ok_or_else(|| missing("mesh", mesh, weights.len()))?;
        if let Some(skin) = node.skin.filter(|&skin| skin >= scenes.skins.len()) {
            return Err(missing("skin", skin, scenes.skins.len()));
        }
        let matrices = match (node.skin, &node.extensions.instancing) {
            (Some(_), _) => vec![IDENTITY],
            (None, Some(instancing)) => {
                self.instances(instancing, &at)?.into_iter().map(|own| product(matrix, own)).collect()
            }
            (None, None) => vec![matrix],
        };
        let weights = node.weights.as_ref().map_or_else(|| of_mesh.clone(), |own| shared_weights(own));
        let node_name = node.name.clone();
        Ok(Some(MeshInstance { mesh, node_name, matrices, weights, skin: node.skin }))
    }

    /// The joint matrices of a skin. `at` is its JSON path; `nodes` has the transforms of the nodes in the
    /// scene, by index.
    fn joints(
        &self,
        skin: &Skin,
        inverses: Option<&[[f32; 16]]>,
        at: &str,
        nodes: &HashMap<usize, Matrix>,
    ) -> Result<Vec<Matrix>, Error> {
        let joint = |(place, joint): (usize, &usize)| {
            let wrong = |problem: &str| self.invalid(format!("{at}.joints[{place}]"), problem);
            let matrix =
                nodes.get(joint).ok_or_else(|| wrong("is not in the scene; export the file again"))?;
            let Some(inverses) = inverses else { return Ok(*matrix) };
            let inverse = inverses
                .get(place)
                .ok_or_else(|| wrong("has no inverse bind matrix; export the file again"))?;
            Ok(product(*matrix, columns(inverse.map(f64::from))))
        };
        skin.joints.iter().enumerate().map(joint).collect()
    }

    /// The transforms of instances relative to their node, whose JSON path is `at`.
    fn instances(&self, instancing: &Instancing, at: &str) -> Result<Vec<Matrix>, Error> {
        let accessor = |name: &str| instancing.attributes.get(name).copied();
        let translations = accessor("TRANSLATION").map(|found| self.vectors::<3>(found)).transpose()?;
        let rotations = accessor("ROTATION").map(|found| self.vectors::<4>(found)).transpose()?;
        let scales = accessor("SCALE").map(|found| self.vectors::<3>(found)).transpose()?;
        let lens = [
            translations.as_ref().map(|t| t.len()),
            rotations.as_ref().map(|r| r.len()),
            scales.as_ref().map(|s| s.len()),
        ];
        // Without transforms there is one instance, at the node.
        let count = lens.into_iter().flatten().next().unwrap_or(1);
        if lens.into_iter().flatten().any(|len| len != count) {
            let problem = "its instances have different numbers of translations, rotations and scales";
            return Err(self.invalid(at, format!("{problem}; export the file again")));
        }
        let instance = |index: usize| {
            let translation = translations.as_ref().map_or([0.0; 3], |all| all[index].map(f64::from));
            let rotation = rotations.as_ref().map_or(no_rotation(), |all| all[index].map(f64::from));
            let scale = scales.as_ref().map_or(no_scale(), |all| all[index].map(f64::from));
            transform(translation, rotation, scale)
        };
        Ok((0..count).map(instance).collect())
    }
}

/// The nodes of the default scene with their transforms, parents before children.
fn nodes_of_scene(
    Scenes { scene, scenes, nodes, .. }: &Scenes,
) -> Result<Vec<(usize, Matrix)>, ContentError> {
    if nodes.is_empty() {
        return Ok(Vec::new());
    }
    let roots = match scenes.get(*scene) {
        Some(scene) => scene.nodes.clone(),
        None if scenes.is_empty() => root_nodes(nodes),
        None => {
            let problem = format!("scene {scene} does not exist: there are {}", scenes.len());
            return Err(ContentError::invalid("scene", format!("{problem}; export the file again")));
        }
    };
    let mut found = Vec::new();
    let mut is_found = vec![false; nodes.len()];
    let mut left: Vec<(usize, Matrix)> = roots.into_iter().rev().map(|root| (root, IDENTITY)).collect();
    while let Some((index, parent)) = left.pop() {
        let at = || format!("nodes[{index}]");
        let (Some(node), Some(is_found)) = (nodes.get(index), is_found.get_mut(index)) else {
            return Err(ContentError::invalid(at(), "does not exist; export the file again"));
        };
        if std::mem::replace(is_found, true) {
            return Err(ContentError::invalid(at(), "is in the scene twice; export the file again"));
        }
        let matrix = product(parent, node.matrix());
        found.push((index, matrix));
        left.extend(node.children.iter().rev().map(|&child| (child, matrix)));
    }
    Ok(found)
}

/// Weights, or none if all are zero.
fn shared_weights(weights: &[f64]) -> Arc<[f64]> {
    if weights.iter().any(|&weight| weight != 0.0) { weights.into() } else { Arc::default() }
}

/// The nodes without a parent.
fn root_nodes(nodes: &[Node]) -> Vec<usize> {
    let mut is_child = vec![false; nodes.len()];
    for &child in nodes.iter().flat_map(|node| &node.children) {
        if let Some(is_child) = is_child.get_mut(child) {
            *is_child = true;
        }
    }
    (0..nodes.len()).filter(|&node| !is_child[node]).collect()
}

impl Node {
    /// The transform from the node to its parent.
    fn matrix(&self) -> Matrix {
        self.matrix.map_or_else(|| transform(self.translation, self.rotation, self.scale), columns)
    }
}

fn columns(numbers: [f64; 16]) -> Matrix {
    [0, 1, 2, 3].map(|column| [0, 1, 2, 3].map(|row| numbers[4 * column + row]))
}

/// The matrix of a translation, a rotation and a scale.
fn transform(translation: [f64; 3], [x, y, z, w]: [f64; 4], scale: [f64; 3]) -> Matrix {
    let rotated = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)],
        [2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)],
        [2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let [a, b, c] = [0, 1, 2].map(|i| rotated[i].map(|part| part * scale[i]));
    let column = |[x, y, z]: [f64; 3], w| [x, y, z, w];
    [column(a, 0.0), column(b, 0.0), column(c, 0.0), column(translation, 1.0)]
}

fn product(a: Matrix, b: Matrix) -> Matrix {
    b.map(|column| [0, 1, 2, 3].map(|row| (0..4).map(|i| a[i][row] * column[i]).sum()))
}

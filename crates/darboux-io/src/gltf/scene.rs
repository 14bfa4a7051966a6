//! Where the meshes of the scene are.

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::Document;
use super::object::read_from_objects;
use crate::Error;
use crate::error::Fault;

/// The columns of a matrix.
type Matrix = [[f64; 4]; 4];

const IDENTITY: Matrix =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// A mesh where a node places it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedMesh {
    /// The index of the mesh.
    pub mesh: usize,
    /// From the mesh to the scene: the columns of a matrix for column vectors.
    pub matrix: [[f64; 4]; 4],
    /// Whether a skin moves its vertices, and not the matrix.
    pub is_skinned: bool,
    /// Whether weights of morph targets move its vertices.
    pub is_morphed: bool,
    /// Whether it is at several places seen from there, by `EXT_mesh_gpu_instancing`.
    pub is_instanced: bool,
}

read_from_objects! { Scenes, Scene, Node, NodeExtensions, Weights }

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
}

/// The weights of a mesh's morph targets, where its node has none.
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
    instancing: Option<IgnoredAny>,
}

fn no_rotation() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

fn no_scale() -> [f64; 3] {
    [1.0; 3]
}

impl Document {
    /// The meshes of the scene that is shown first, with all their nodes say, as they were read.
    ///
    /// A document without scenes shows all nodes, one without nodes all meshes. Errors: nodes that are not there, or have several
    /// parents.
    pub fn placed_meshes(&self) -> Result<Vec<PlacedMesh>, Error> {
        self.place_meshes().map_err(|fault| fault.in_file(self.name()))
    }

    fn place_meshes(&self) -> Result<Vec<PlacedMesh>, Fault> {
        let Scenes { scene, scenes, nodes, meshes } = self.parsed()?;
        if nodes.is_empty() {
            return Ok((0..meshes.len()).map(|mesh| place(None, mesh, &meshes, IDENTITY)).collect());
        }
        let roots = match scenes.get(scene) {
            Some(scene) => scene.nodes.clone(),
            None if scenes.is_empty() => orphans(&nodes),
            None => {
                let problem = format!("scene {scene} does not exist: there are {}", scenes.len());
                return Err(Fault::invalid("scene", format!("{problem}; export the file again")));
            }
        };
        let mut placed = Vec::new();
        let mut is_placed = vec![false; nodes.len()];
        let mut left: Vec<(usize, Matrix)> = roots.into_iter().rev().map(|root| (root, IDENTITY)).collect();
        while let Some((index, parent)) = left.pop() {
            let at = || format!("nodes[{index}]");
            let (Some(node), Some(is_placed)) = (nodes.get(index), is_placed.get_mut(index)) else {
                return Err(Fault::invalid(at(), "does not exist; export the file again"));
            };
            if std::mem::replace(is_placed, true) {
                return Err(Fault::invalid(at(), "is in the scene twice; export the file again"));
            }
            let matrix = product(parent, node.matrix());
            if let Some(mesh) = node.mesh {
                if mesh >= meshes.len() {
                    let problem = format!("mesh {mesh} does not exist: there are {}", meshes.len());
                    return Err(Fault::invalid(at(), format!("{problem}; export the file again")));
                }
                placed.push(place(Some(node), mesh, &meshes, matrix));
            }
            left.extend(node.children.iter().rev().map(|&child| (child, matrix)));
        }
        Ok(placed)
    }
}

/// A mesh as its node has it, if it has one.
fn place(node: Option<&Node>, mesh: usize, meshes: &[Weights], matrix: Matrix) -> PlacedMesh {
    let of_mesh = meshes.get(mesh).map(|mesh| &mesh.weights);
    let weights = node.and_then(|node| node.weights.as_ref()).or(of_mesh);
    PlacedMesh {
        mesh,
        matrix,
        is_skinned: node.is_some_and(|node| node.skin.is_some()),
        is_morphed: weights.is_some_and(|weights| weights.iter().any(|&weight| weight != 0.0)),
        is_instanced: node.is_some_and(|node| node.extensions.instancing.is_some()),
    }
}

/// The nodes that are no children.
fn orphans(nodes: &[Node]) -> Vec<usize> {
    let mut is_child = vec![false; nodes.len()];
    for &child in nodes.iter().flat_map(|node| &node.children) {
        if let Some(is_child) = is_child.get_mut(child) {
            *is_child = true;
        }
    }
    (0..nodes.len()).filter(|&node| !is_child[node]).collect()
}

impl Node {
    /// From the node to its parent: the matrix, or translation times rotation times scale.
    fn matrix(&self) -> Matrix {
        if let Some(matrix) = self.matrix {
            return [0, 1, 2, 3].map(|column| [0, 1, 2, 3].map(|row| matrix[4 * column + row]));
        }
        let [x, y, z, w] = self.rotation;
        let turned = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)],
            [2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)],
            [2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        let [a, b, c] = [0, 1, 2].map(|i| turned[i].map(|part| part * self.scale[i]));
        let column = |[x, y, z]: [f64; 3], w| [x, y, z, w];
        [column(a, 0.0), column(b, 0.0), column(c, 0.0), column(self.translation, 1.0)]
    }
}

fn product(a: Matrix, b: Matrix) -> Matrix {
    b.map(|column| [0, 1, 2, 3].map(|row| (0..4).map(|i| a[i][row] * column[i]).sum()))
}

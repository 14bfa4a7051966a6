//! Instances of a document's primitives in the scene.

use std::borrow::Cow;
use std::sync::Arc;

use darboux::Transform;
use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners};

/// A matrix for column vectors, in columns.
pub type Matrix = [[f64; 4]; 4];

/// An instance of a mesh in the scene.
#[derive(Clone, Debug)]
pub struct Instance {
    pub matrix: Matrix,
    /// The name of the node.
    pub node_name: Option<Arc<str>>,
    /// The number of the instance in the scene.
    pub number: usize,
}

/// The instances of every mesh, by the index of the mesh. A skinned mesh has the pose in which it is stored.
pub fn instances_of_meshes(document: &Document) -> Result<Vec<Vec<Instance>>, Error> {
    let mut instances = vec![Vec::new(); document.meshes().len()];
    let mut number = 0;
    for mesh in document.mesh_instances()?.meshes {
        let node_name: Option<Arc<str>> = mesh.node_name.map(Arc::from);
        for matrix in mesh.matrices {
            if let Some(instances) = instances.get_mut(mesh.mesh) {
                instances.push(Instance { matrix, node_name: node_name.clone(), number });
                number += 1;
            }
        }
    }
    Ok(instances)
}

/// Positions and normals of an instance of a primitive, and the vertices of its triangles.
#[derive(Clone, Debug)]
pub struct PrimitiveInstance<'a> {
    /// The name of the node, or else of the mesh; empty if neither has one.
    pub part_name: Arc<str>,
    pub positions: Cow<'a, [[f32; 3]]>,
    pub normals: Option<Cow<'a, [[f32; 3]]>>,
    pub indices: Cow<'a, [u32]>,
    /// None for an instance without a matrix.
    pub transform: Option<Transform>,
}

impl<'a> PrimitiveInstance<'a> {
    /// Reads a primitive; none where it has no positions. A mirroring matrix reverses the triangles. Errors:
    /// invalid data.
    pub fn read(corners: &'a PrimitiveCorners<'a>, instance: &Instance) -> Result<Option<Self>, Error> {
        let Some(positions) = corners.used_vectors("POSITION")? else { return Ok(None) };
        let normals = corners.used_vectors("NORMAL")?;
        let indices = Cow::Borrowed(corners.used_indices());
        let part_name = instance.node_name.as_ref().or(corners.name().mesh_name.as_ref());
        let part_name = part_name.cloned().unwrap_or_default();
        let primitive = Self { part_name, positions, normals, indices, transform: None };
        Ok(Some(if is_identity(&instance.matrix) { primitive } else { primitive.moved(&instance.matrix) }))
    }

    fn moved(mut self, matrix: &Matrix) -> Self {
        let [a, b, c, d] = matrix;
        let transform = Transform::new([a, b, c].map(|column| [0, 1, 2].map(|row| column[row] as f32)));
        for position in self.positions.to_mut() {
            let [x, y, z] = position.map(f64::from);
            *position = [0, 1, 2].map(|i| (a[i] * x + b[i] * y + c[i] * z + d[i]) as f32);
        }
        for normal in self.normals.iter_mut().flat_map(Cow::to_mut) {
            *normal = transform.normal(*normal);
        }
        if transform.orientation() < 0.0 {
            reverse(self.indices.to_mut());
        }
        self.transform = Some(transform);
        self
    }
}

/// Reverses triangles, given by one element per corner.
pub fn reverse<T>(corners: &mut [T]) {
    corners.as_chunks_mut::<3>().0.iter_mut().for_each(|triangle| triangle.swap(1, 2));
}

fn is_identity(matrix: &Matrix) -> bool {
    let expected = |column: usize, row: usize| f64::from(u8::from(column == row));
    matrix.iter().enumerate().all(|(i, column)| column.iter().enumerate().all(|(k, &x)| x == expected(i, k)))
}

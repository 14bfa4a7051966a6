//! The name of a primitive in messages and reports.

use std::fmt;
use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::gltf::schema::Mesh;

/// A primitive in messages and reports: `meshes[2].primitives[0] "Body"`. Names are equal if their indices
/// are.
#[derive(Clone, Debug, Serialize)]
pub struct PrimitiveName {
    /// The index of the mesh.
    pub mesh: usize,
    /// The name of the mesh, if there is one. Messages and reports show its first 200 characters.
    #[serde(serialize_with = "write_shortened")]
    pub mesh_name: Option<Arc<str>>,
    /// The index of the primitive in the mesh.
    pub primitive: usize,
}

impl PrimitiveName {
    /// The name of the primitive with an index in the mesh `meshes[mesh_index]`.
    pub fn new(mesh_index: usize, mesh: &Mesh, primitive: usize) -> Self {
        Self { mesh: mesh_index, mesh_name: mesh.name.clone(), primitive }
    }

    /// The JSON path, such as `meshes[2].primitives[0]`.
    pub fn path(&self) -> String {
        format!("meshes[{}].primitives[{}]", self.mesh, self.primitive)
    }

    /// The name of the mesh as messages and reports show it.
    pub fn shown_mesh_name(&self) -> Option<String> {
        self.mesh_name.as_deref().map(first_characters)
    }
}

impl PartialEq for PrimitiveName {
    fn eq(&self, other: &Self) -> bool {
        (self.mesh, self.primitive) == (other.mesh, other.primitive)
    }
}

impl Eq for PrimitiveName {}

/// A mesh can have thousands of primitives and a name of a megabyte.
const LONGEST_SHOWN: usize = 200;

fn first_characters(name: &str) -> String {
    match name.char_indices().nth(LONGEST_SHOWN) {
        Some((end, _)) => format!("{}...", &name[..end]),
        None => name.to_owned(),
    }
}

fn write_shortened<S: Serializer>(name: &Option<Arc<str>>, serializer: S) -> Result<S::Ok, S::Error> {
    name.as_deref().map(first_characters).serialize(serializer)
}

impl fmt::Display for PrimitiveName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.path())?;
        match self.shown_mesh_name() {
            Some(name) => write!(f, " {name:?}"),
            None => Ok(()),
        }
    }
}

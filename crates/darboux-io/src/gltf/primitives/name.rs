//! The name of a primitive in messages and reports.

use std::fmt;

use serde::Serialize;

/// A primitive in messages and reports: `meshes[2].primitives[0] "Body"`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PrimitiveName {
    /// The index of the mesh.
    pub mesh: usize,
    /// The name of the mesh, if there is one.
    pub mesh_name: Option<String>,
    /// The index of the primitive in the mesh.
    pub primitive: usize,
}

impl PrimitiveName {
    /// The JSON path, such as `meshes[2].primitives[0]`.
    pub fn path(&self) -> String {
        format!("meshes[{}].primitives[{}]", self.mesh, self.primitive)
    }
}

impl fmt::Display for PrimitiveName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.path())?;
        match &self.mesh_name {
            Some(name) => write!(f, " {name:?}"),
            None => Ok(()),
        }
    }
}

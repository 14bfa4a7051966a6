//! Orthogonalisation of full frames: the bitangent that shaders compute from the normal, the tangent and the
//! sign.

use crate::CornerFrames;
use crate::Error;
use crate::Mesh;

use crate::tangents::repair::across;

impl CornerFrames {
    /// The same frames with the bitangent that shaders rebuild: sign * cross(normal, tangent), unit. The
    /// tangent stays.
    ///
    /// Without a normal it is a perpendicular of the tangent. Errors: frames of another number of corners.
    pub fn orthogonalized(mut self, mesh: &Mesh<'_>) -> Result<Self, Error> {
        Error::check_input("frames", mesh.corner_count(), self.0.len())?;
        for (corner, frame) in self.0.iter_mut().enumerate() {
            let normal = mesh.normals().get(mesh.vertex_of_corner(corner));
            frame.bitangent = across(normal, frame.tangent, frame.sign);
        }
        Ok(self)
    }
}

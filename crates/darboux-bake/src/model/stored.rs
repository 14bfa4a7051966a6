//! Tangents of a document's primitives, as the file has them or computed.

use darboux::{Convention, Indices, Mesh, TangentOptions, Transform, generate_tangents};
use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners};

use super::instance::reverse;

/// A primitive as the file has it, before the transform of its instance.
pub struct StoredPrimitive<'a> {
    pub document: &'a Document,
    pub corners: &'a PrimitiveCorners<'a>,
    pub uvs: &'a [[f32; 2]],
}

impl StoredPrimitive<'_> {
    /// The tangents of an instance of the primitive: the file's, or computed ones with options.
    pub fn tangents(
        &self,
        options: Option<&TangentOptions>,
        transform: Option<&Transform>,
    ) -> Result<Vec<[f32; 4]>, Error> {
        let mut tangents = match options {
            None => self.own_tangents()?,
            Some(options) => self.computed_tangents(options)?,
        };
        if let Some(transform) = transform {
            let normals = self.corners.used_vectors("NORMAL")?.unwrap_or_default();
            move_tangents(&mut tangents, self.corners, &normals, transform);
        }
        Ok(tangents)
    }

    /// The file's tangents, converted to those that [`generate_tangents`] would return.
    fn own_tangents(&self) -> Result<Vec<[f32; 4]>, Error> {
        let conversion = Convention::GLTF.to(Convention::GLTF.generated());
        let tangents = self.corners.vectors::<4>("TANGENT")?.unwrap_or_default();
        Ok(tangents.into_iter().map(|tangent| conversion.tangent(tangent)).collect())
    }

    fn computed_tangents(&self, options: &TangentOptions) -> Result<Vec<[f32; 4]>, Error> {
        let (document, name) = (self.document, self.corners.name());
        let positions = self.corners.used_vectors::<3>("POSITION")?.unwrap_or_default();
        let normals = self.corners.used_vectors::<3>("NORMAL")?.unwrap_or_default();
        let mesh =
            Mesh::triangles(&*positions, &*normals, self.uvs, Indices::U32(self.corners.used_indices()));
        let mesh =
            mesh.map_err(|source| Error::Mesh { file: document.name().to_owned(), at: name.path(), source })?;
        Ok(generate_tangents(&mesh, options).corners.into_per_corner())
    }
}

/// Transforms tangents with the instance of their primitive. `normals`: of its own vertices, as the file has
/// them.
fn move_tangents(
    tangents: &mut [[f32; 4]],
    corners: &PrimitiveCorners<'_>,
    normals: &[[f32; 3]],
    transform: &Transform,
) {
    for (tangent, &vertex) in tangents.iter_mut().zip(corners.used_indices()) {
        let normal = normals.get(vertex as usize).copied().unwrap_or_default();
        (_, *tangent) = transform.frame(normal, *tangent);
    }
    if transform.orientation() < 0.0 {
        reverse(tangents);
    }
}

//! [`HighModel`]: the surfaces of a document that have the detail.

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners, PrimitiveName};

use super::placed::{PlacedPrimitive, places};
use crate::{BakeError, HighSurface};

/// The triangles of a document's scene at all their places, without animation and in the pose in which skinned meshes are stored.
#[derive(Debug)]
pub struct HighModel<'a> {
    file: String,
    parts: Vec<(PrimitiveName, PlacedPrimitive<'a>)>,
}

impl<'a> HighModel<'a> {
    /// Reads the model. `corners`: [`Document::corners`] of the same document. Errors: invalid data.
    pub fn read(document: &'a Document, corners: &'a [PrimitiveCorners<'a>]) -> Result<Self, Error> {
        let places = places(document)?;
        let mut parts = Vec::new();
        for corners in corners {
            for place in places.get(corners.name().mesh).into_iter().flatten() {
                let primitive = PlacedPrimitive::read(document, corners, place)?;
                parts.extend(primitive.map(|primitive| (corners.name().clone(), primitive)));
            }
        }
        Ok(Self { file: document.name().to_owned(), parts })
    }

    /// The surfaces. Errors: an index out of range.
    pub fn surfaces(&self) -> Result<Vec<HighSurface<'_>>, Error> {
        let mut surfaces = Vec::new();
        for (name, part) in &self.parts {
            let normals = part.normals.as_deref().map(Into::into);
            let surface = HighSurface::new(&*part.positions, normals, &*part.indices);
            surfaces.push(surface.map_err(|error| self.mesh_error(name, error))?);
        }
        Ok(surfaces)
    }

    fn mesh_error(&self, name: &PrimitiveName, error: BakeError) -> Error {
        let (file, at) = (self.file.clone(), name.path());
        match error {
            BakeError::Mesh(source) => Error::Mesh { file, at, source },
            other => Error::Unsupported { file, at, problem: other.to_string() },
        }
    }

    /// The name of each surface: that of its node, or else of its mesh; empty if neither has one.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parts.iter().map(|(_, part)| part.part_name.as_str())
    }

    /// The number of primitives without normals, whose triangles are flat.
    pub fn flat_count(&self) -> usize {
        self.parts.iter().filter(|(_, part)| part.normals.is_none()).count()
    }
}

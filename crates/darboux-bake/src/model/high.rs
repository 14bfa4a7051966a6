//! [`HighModel`]: the surfaces of a document that have the detail.

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners, PrimitiveName};

use super::maps::{MapOnPart, Textures};
use super::placed::{PlacedPrimitive, places};
use crate::{BakeError, HighSurface};

/// How a high model is read.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HighModelOptions {
    /// Whether surfaces have the normals that their materials' normal maps show. Default: yes.
    pub normal_maps: bool,
}

impl Default for HighModelOptions {
    fn default() -> Self {
        Self { normal_maps: true }
    }
}

impl HighModelOptions {
    /// These options with the normal maps of materials, or without.
    #[must_use]
    pub fn with_normal_maps(self, normal_maps: bool) -> Self {
        Self { normal_maps, ..self }
    }
}

/// The triangles of a document's scene at all their places, without animation and in the pose in which skinned meshes are stored.
#[derive(Debug)]
pub struct HighModel<'a> {
    file: String,
    parts: Vec<HighPart<'a>>,
    textures: Textures,
}

#[derive(Debug)]
struct HighPart<'a> {
    name: PrimitiveName,
    primitive: PlacedPrimitive<'a>,
    map: Option<MapOnPart<'a>>,
}

impl<'a> HighModel<'a> {
    /// Reads the model. `corners`: [`Document::corners`] of the same document. Errors: invalid data.
    ///
    /// A normal map that cannot be used is left out; [`HighModel::warnings`] says why.
    pub fn read(
        document: &'a Document,
        corners: &'a [PrimitiveCorners<'a>],
        options: &HighModelOptions,
    ) -> Result<Self, Error> {
        let places = places(document)?;
        let mut textures = Textures::default();
        let mut parts = Vec::new();
        for corners in corners {
            let texture = match options.normal_maps {
                true => textures.of_primitive(document, corners)?,
                false => None,
            };
            for place in places.get(corners.name().mesh).into_iter().flatten() {
                let Some(primitive) = PlacedPrimitive::read(document, corners, place)? else { continue };
                let map = texture.map(|texture| textures.on_part(document, corners, texture, &primitive));
                let map = map.transpose()?.flatten();
                parts.push(HighPart { name: corners.name().clone(), primitive, map });
            }
        }
        Ok(Self { file: document.name().to_owned(), parts, textures })
    }

    /// Reads several models. `corners`: [`Document::corners`] of each document. Errors: as of [`HighModel::read`].
    pub fn read_all(
        documents: &'a [Document],
        corners: &'a [Vec<PrimitiveCorners<'a>>],
        options: &HighModelOptions,
    ) -> Result<Vec<Self>, Error> {
        documents
            .iter()
            .zip(corners)
            .map(|(document, corners)| Self::read(document, corners, options))
            .collect()
    }

    /// The surfaces of several models, one model after the other. Errors: an index out of range.
    pub fn surfaces_of_all(models: &[Self]) -> Result<Vec<HighSurface<'_>>, Error> {
        let surfaces: Vec<_> = models.iter().map(HighModel::surfaces).collect::<Result<_, _>>()?;
        Ok(surfaces.into_iter().flatten().collect())
    }

    /// The surfaces. Errors: an index out of range.
    pub fn surfaces(&self) -> Result<Vec<HighSurface<'_>>, Error> {
        let mut surfaces = Vec::new();
        for HighPart { name, primitive, map } in &self.parts {
            let normals = primitive.normals.as_deref().map(Into::into);
            let surface = HighSurface::new(&*primitive.positions, normals, &*primitive.indices);
            let surface = surface.and_then(|surface| match map {
                Some(map) => {
                    surface.with_normal_map(self.textures.get(map.texture), &*map.uvs, &map.tangents)
                }
                None => Ok(surface),
            });
            surfaces.push(surface.map_err(|error| self.mesh_error(name, error))?);
        }
        Ok(surfaces)
    }

    /// The number of primitives whose normal maps count.
    pub fn mapped_count(&self) -> usize {
        self.parts.iter().filter(|part| part.map.is_some()).count()
    }

    /// Why normal maps were left out, one sentence each.
    pub fn warnings(&self) -> &[String] {
        &self.textures.warnings
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
        self.parts.iter().map(|part| part.primitive.part_name.as_str())
    }

    /// The number of primitives without normals, whose triangles are flat.
    pub fn flat_count(&self) -> usize {
        self.parts.iter().filter(|part| part.primitive.normals.is_none()).count()
    }
}

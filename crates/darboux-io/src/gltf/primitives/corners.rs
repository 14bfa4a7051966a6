//! The corners of a primitive's triangles, and its attributes at each corner.

use std::borrow::Cow;

use super::name::PrimitiveName;
use super::triangles::TriangleMode;
use super::used_vertices::UsedVertices;
use super::{element_count, limits};
use crate::Error;
use crate::gltf::Document;
use crate::gltf::schema::{self, Attributes};

/// The corners of a primitive's triangles, three per triangle, in the order of the file. Strips and fans are
/// converted to triangles.
#[derive(Debug)]
pub struct PrimitiveCorners<'a> {
    document: &'a Document,
    name: PrimitiveName,
    primitive: &'a schema::Primitive,
    vertices: Vec<u32>,
    /// None where all vertices of the accessors are read.
    used: Option<UsedVertices>,
}

impl<'a> PrimitiveCorners<'a> {
    /// The corners of a primitive; none for points and lines. Errors: invalid indices.
    pub(in crate::gltf) fn find(
        document: &'a Document,
        name: &PrimitiveName,
        primitive: &'a schema::Primitive,
    ) -> Result<Option<Self>, Error> {
        let Some(topology) = TriangleMode::from_mode(primitive.mode) else { return Ok(None) };
        let mut indices = match (primitive.indices, primitive.attributes.get("POSITION")) {
            (Some(accessor), _) => document.indices(accessor)?.into_u32(),
            (None, Some(&position)) => (0..element_count(document, position)? as u32).collect(),
            (None, None) => Vec::new(),
        };
        indices.truncate(topology.whole(indices.len()));
        let vertices = topology.corners(indices);
        let position = primitive.attributes.get("POSITION");
        let count = position.map_or(Ok(0), |&position| element_count(document, position))?;
        let used = UsedVertices::of(&vertices, count);
        Ok(Some(Self { document, name: name.clone(), primitive, vertices, used }))
    }

    /// The primitive.
    pub fn name(&self) -> &PrimitiveName {
        &self.name
    }

    /// The index of the material, if there is one.
    pub fn material(&self) -> Option<usize> {
        self.primitive.material
    }

    /// The vertex of every corner: an index into the primitive's attributes. It can be out of range.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// The number of corners.
    pub fn len(&self) -> usize {
        self.vertices.len()
    }

    /// Whether there are no corners.
    pub fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// The values of an attribute at every corner, as floats; none if the primitive does not have it.
    ///
    /// `semantic` is the name of the attribute, such as `TEXCOORD_0`. Errors: invalid data; an index out of
    /// range.
    pub fn vectors<const N: usize>(&self, semantic: &str) -> Result<Option<Vec<[f32; N]>>, Error> {
        self.gathered(&self.primitive.attributes, semantic)
    }

    /// The offsets of an attribute by a morph target at every corner; none if the target does not change it.
    ///
    /// `target` is the index of the morph target. Errors: as [`PrimitiveCorners::vectors`].
    pub fn offsets(&self, target: usize, semantic: &str) -> Result<Option<Vec<[f32; 3]>>, Error> {
        let target = self.primitive.targets.get(target);
        target.map_or(Ok(None), |target| self.gathered(target, semantic))
    }

    /// The values of an attribute as floats, in the order of the file; none if the primitive does not have
    /// it. [`PrimitiveCorners::used_indices`] has the place of every corner's value.
    ///
    /// The vectors of all vertices of the accessor; where the accessor has more vertices than the primitive
    /// has corners, as an accessor that primitives share, only of the vertices that the corners use. The
    /// lists of all attributes have the same vertices. Errors: as [`PrimitiveCorners::vectors`].
    pub fn used_vectors<const N: usize>(&self, semantic: &str) -> Result<Option<Cow<'a, [[f32; N]]>>, Error> {
        self.checked(&self.primitive.attributes, semantic)
    }

    /// The place of every corner's value in the lists of [`PrimitiveCorners::used_vectors`].
    pub fn used_indices(&self) -> &[u32] {
        self.used.as_ref().map_or(&self.vertices, |used| &used.of_corner)
    }

    /// The vertex in the accessors of each place in the lists of [`PrimitiveCorners::used_vectors`]; none
    /// where they are the same.
    pub fn used_vertices(&self) -> Option<&[u32]> {
        self.used.as_ref().map(|used| used.vertices.as_slice())
    }

    /// As [`PrimitiveCorners::used_indices`], without a copy.
    pub(in crate::gltf) fn into_used_indices(self) -> Vec<u32> {
        self.used.map_or(self.vertices, |used| used.of_corner)
    }

    fn gathered<const N: usize>(
        &self,
        attributes: &Attributes,
        semantic: &str,
    ) -> Result<Option<Vec<[f32; N]>>, Error> {
        let vectors = self.checked(attributes, semantic)?;
        Ok(vectors.map(|vectors| self.used_indices().iter().map(|&own| vectors[own as usize]).collect()))
    }

    /// An attribute's values, one for each of the primitive's own vertices. Errors: invalid data; a corner's
    /// vertex is out of range.
    fn checked<const N: usize>(
        &self,
        attributes: &Attributes,
        semantic: &str,
    ) -> Result<Option<Cow<'a, [[f32; N]]>>, Error> {
        let Some(&accessor) = attributes.get(semantic) else { return Ok(None) };
        let vertices = element_count(self.document, accessor)?;
        if let Some(at) = self.vertices.iter().position(|&vertex| vertex as usize >= vertices) {
            let problem = darboux::Error::IndexOutOfRange { at, index: self.vertices[at], vertices };
            return Err(self.document.mesh_error(self.name.path(), problem));
        }
        Ok(Some(match &self.used {
            Some(used) => self.document.vectors_at(accessor, &used.vertices)?.into(),
            None => self.document.vectors(accessor)?,
        }))
    }
}

impl Document {
    /// The corners of every primitive that has triangles.
    ///
    /// Errors: invalid indices; more corners than the memory limit permits.
    pub fn corners(&self) -> Result<Vec<PrimitiveCorners<'_>>, Error> {
        let primitives = || self.meshes().iter().flat_map(|mesh| &mesh.primitives);
        limits::check_triangles(self, primitives().filter_map(|primitive| triangle_count(self, primitive)))?;
        let mut found = Vec::new();
        for (index, mesh) in self.meshes().iter().enumerate() {
            for (place, primitive) in mesh.primitives.iter().enumerate() {
                let name = PrimitiveName::new(index, mesh, place);
                found.extend(PrimitiveCorners::find(self, &name, primitive)?);
            }
        }
        Ok(found)
    }

    /// Checks a number of triangles that are to be kept, as of all instances of meshes. Errors: more than the
    /// memory limit permits.
    pub fn check_triangle_count(&self, triangles: usize) -> Result<(), Error> {
        limits::check_triangles(self, std::iter::once(triangles))
    }

    /// As [`Document::check_triangle_count`], for UVs.
    pub fn check_uv_count(&self, uvs: usize) -> Result<(), Error> {
        limits::check_uvs(self, uvs)
    }

    /// Checks bytes that edits are to add. Errors: together with the bytes of earlier edits, more than the
    /// memory limit permits.
    pub fn check_new_bytes(&self, bytes: usize) -> Result<(), Error> {
        limits::check_more_output(self, bytes)
    }

    /// The corners of one primitive; none for points and lines, and where it does not exist. Errors: as
    /// [`Document::corners`].
    pub fn corners_of(&self, name: &PrimitiveName) -> Result<Option<PrimitiveCorners<'_>>, Error> {
        let mesh = self.meshes().get(name.mesh);
        let Some(primitive) = mesh.and_then(|mesh| mesh.primitives.get(name.primitive)) else {
            return Ok(None);
        };
        limits::check_triangles(self, triangle_count(self, primitive).into_iter())?;
        PrimitiveCorners::find(self, name, primitive)
    }
}

/// The number of triangles of a primitive, by the counts of its accessors; none for points and lines.
pub fn triangle_count(document: &Document, primitive: &schema::Primitive) -> Option<usize> {
    let source = primitive.indices.or_else(|| primitive.attributes.get("POSITION").copied());
    let count = source.and_then(|accessor| document.accessors().get(accessor)).map_or(0, |found| found.count);
    TriangleMode::from_mode(primitive.mode).map(|topology| topology.triangle_count(count))
}

//! [`LowModel`]: the surfaces of a document that receive the detail, with their tangents.

use std::borrow::Cow;

use darboux::{Convention, Indices, Mesh, TangentOptions, Transform, generate_tangents};
use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners, PrimitiveName};

use super::placed::{PlacedPrimitive, places, reverse, vertices};
use crate::LowSurface;

/// How the low model is read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct LowModelOptions {
    /// The n of `TEXCOORD_n`. Default: for each primitive the set that the normal map of its material uses.
    pub uv_set: Option<usize>,
    /// How tangents are computed. Default: the file's tangents, and MikkTSpace's where it has none.
    pub tangents: Option<TangentOptions>,
}

impl LowModelOptions {
    /// These options with a UV set, or with that of each normal map.
    #[must_use]
    pub fn with_uv_set(self, uv_set: Option<usize>) -> Self {
        Self { uv_set, ..self }
    }

    /// These options with tangents that are computed, or with those of the file.
    #[must_use]
    pub fn with_tangents(self, tangents: Option<TangentOptions>) -> Self {
        Self { tangents, ..self }
    }
}

/// The triangles of a document's scene at the first of their places, without animation and in the pose in which skinned meshes are stored.
#[derive(Debug)]
pub struct LowModel<'a> {
    parts: Vec<LowPart<'a>>,
    /// Meshes that the scene has at more than one place. The first is baked.
    pub repeated_meshes: usize,
    /// Primitives without UVs. They are not baked.
    pub without_uvs: usize,
    /// Primitives whose tangents come from the file.
    pub with_own_tangents: usize,
}

#[derive(Debug)]
struct LowPart<'a> {
    name: PrimitiveName,
    file: &'a str,
    primitive: PlacedPrimitive<'a>,
    /// At the place of the primitive.
    normals: Cow<'a, [[f32; 3]]>,
    uvs: Cow<'a, [[f32; 2]]>,
    tangents: Vec<[f32; 4]>,
}

impl<'a> LowModel<'a> {
    /// Reads the model. `corners`: [`Document::corners`] of the same document. Errors: invalid data; a primitive without normals.
    pub fn read(
        document: &'a Document,
        corners: &'a [PrimitiveCorners<'a>],
        options: &LowModelOptions,
    ) -> Result<Self, Error> {
        let (places, appearances) = (places(document)?, document.appearances()?);
        let mut model = Self { parts: Vec::new(), repeated_meshes: 0, without_uvs: 0, with_own_tangents: 0 };
        model.repeated_meshes = places.iter().filter(|places| places.len() > 1).count();
        for corners in corners.iter().filter(|corners| !corners.is_empty()) {
            let name = corners.name();
            let Some(place) = places.get(name.mesh).and_then(|places| places.first()) else { continue };
            let Some(primitive) = PlacedPrimitive::read(document, corners, place)? else { continue };
            let appearance = corners.material().and_then(|material| appearances.get(material));
            let of_map = appearance.map_or(0, |appearance| appearance.tangent_uv_set);
            let uv_set = options.uv_set.unwrap_or(of_map);
            let Some(uvs) = vertices(document, name, &format!("TEXCOORD_{uv_set}"))? else {
                model.without_uvs += 1;
                continue;
            };
            let Some(normals) = primitive.normals.clone() else {
                return Err(without_normals(document, name));
            };
            let is_own = options.tangents.is_none() && vertices::<4>(document, name, "TANGENT")?.is_some();
            model.with_own_tangents += usize::from(is_own);
            let stored = StoredPrimitive { document, corners, uvs: &uvs };
            let mut tangents = match is_own {
                true => stored.own_tangents()?,
                false => stored.computed_tangents(&options.tangents.unwrap_or_default())?,
            };
            if let Some(transform) = &primitive.transform {
                let normals = vertices(document, name, "NORMAL")?.unwrap_or_default();
                move_tangents(&mut tangents, corners, &normals, transform);
            }
            let (name, file) = (name.clone(), document.name());
            model.parts.push(LowPart { name, file, primitive, normals, uvs, tangents });
        }
        Ok(model)
    }

    /// The surfaces. Errors: an index out of range.
    pub fn surfaces(&self) -> Result<Vec<LowSurface<'_>>, Error> {
        let mut surfaces = Vec::new();
        for part in &self.parts {
            let surface = LowSurface::new(part.mesh()?, &part.tangents);
            surfaces.push(surface.map_err(|error| Error::Unsupported {
                file: part.file.to_owned(),
                at: part.name.path(),
                problem: error.to_string(),
            })?);
        }
        Ok(surfaces)
    }

    /// The name of each surface: that of its node, or else of its mesh; empty if neither has one.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parts.iter().map(|part| part.primitive.part_name.as_str())
    }

    /// The diagonal of the box around the model, in units of its positions.
    pub fn diagonal(&self) -> f64 {
        let positions = || self.parts.iter().flat_map(|part| part.primitive.positions.iter());
        let finite = |i: usize| positions().map(move |p| f64::from(p[i])).filter(|x| x.is_finite());
        let extent =
            |i: usize| finite(i).fold(f64::NEG_INFINITY, f64::max) - finite(i).fold(f64::INFINITY, f64::min);
        let square: f64 = [0, 1, 2].map(|i| extent(i).max(0.0).powi(2)).iter().sum();
        square.sqrt()
    }
}

impl LowPart<'_> {
    fn mesh(&self) -> Result<Mesh<'_>, Error> {
        let indices = Indices::U32(&self.primitive.indices);
        Mesh::triangles(&*self.primitive.positions, &*self.normals, &*self.uvs, indices)
            .map_err(|source| Error::Mesh { file: self.file.to_owned(), at: self.name.path(), source })
    }
}

fn without_normals(document: &Document, name: &PrimitiveName) -> Error {
    Error::Unsupported {
        file: document.name().to_owned(),
        at: name.path(),
        problem: "has no normals, which the frames of a normal map need; generate them first".to_owned(),
    }
}

/// A primitive as the file has it, before it is placed.
struct StoredPrimitive<'a> {
    document: &'a Document,
    corners: &'a PrimitiveCorners<'a>,
    uvs: &'a [[f32; 2]],
}

impl StoredPrimitive<'_> {
    /// The file's tangents, converted to those that [`generate_tangents`] would return.
    fn own_tangents(&self) -> Result<Vec<[f32; 4]>, Error> {
        let conversion = Convention::GLTF.to(Convention::GLTF.generated());
        let tangents = self.corners.vectors::<4>("TANGENT")?.unwrap_or_default();
        Ok(tangents.into_iter().map(|tangent| conversion.tangent(tangent)).collect())
    }

    fn computed_tangents(&self, options: &TangentOptions) -> Result<Vec<[f32; 4]>, Error> {
        let (document, name) = (self.document, self.corners.name());
        let positions = vertices::<3>(document, name, "POSITION")?.unwrap_or_default();
        let normals = vertices::<3>(document, name, "NORMAL")?.unwrap_or_default();
        let mesh = Mesh::triangles(&*positions, &*normals, self.uvs, Indices::U32(self.corners.vertices()));
        let mesh =
            mesh.map_err(|source| Error::Mesh { file: document.name().to_owned(), at: name.path(), source })?;
        Ok(generate_tangents(&mesh, options).corners.into_per_corner())
    }
}

/// Moves tangents to the place of their primitive. `normals`: of the vertices, as the file has them.
fn move_tangents(
    tangents: &mut [[f32; 4]],
    corners: &PrimitiveCorners<'_>,
    normals: &[[f32; 3]],
    transform: &Transform,
) {
    for (tangent, &vertex) in tangents.iter_mut().zip(corners.vertices()) {
        let normal = normals.get(vertex as usize).copied().unwrap_or_default();
        (_, *tangent) = transform.frame(normal, *tangent);
    }
    if transform.orientation() < 0.0 {
        reverse(tangents);
    }
}

//! [`LowModel`]: the surfaces of a document that receive the detail, with their tangents.

use std::borrow::Cow;
use std::collections::{BTreeSet, HashSet};

use darboux::{Indices, Mesh, TangentOptions};
use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners, PrimitiveName};

use super::content::colors;
use super::instance::{PrimitiveInstance, instances_of_meshes};
use super::stored::StoredPrimitive;
use crate::LowSurface;
use crate::text::listed;
use crate::vector::box_diagonal;

/// How the low model is read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct LowModelOptions {
    /// The n of `TEXCOORD_n`. Default: for each primitive the set that the normal map of its material uses.
    pub uv_set: Option<usize>,
    /// How tangents are computed. Default: the file's tangents, and MikkTSpace's where it has none for the
    /// UV set.
    pub tangents: Option<TangentOptions>,
    /// The index of the only material whose primitives are baked. Default: all primitives.
    pub material: Option<usize>,
}

impl LowModelOptions {
    /// These options with a UV set, or with the UV set of each normal map.
    #[must_use]
    pub fn with_uv_set(self, uv_set: Option<usize>) -> Self {
        Self { uv_set, ..self }
    }

    /// These options with computed tangents, or with the file's tangents.
    #[must_use]
    pub fn with_tangents(self, tangents: Option<TangentOptions>) -> Self {
        Self { tangents, ..self }
    }

    /// These options with the only material that is baked, or with all.
    #[must_use]
    pub fn with_material(self, material: Option<usize>) -> Self {
        Self { material, ..self }
    }
}

/// The triangles of a document's scene in the first of their instances, without animation and in the pose in
/// which skinned meshes are stored.
#[derive(Debug)]
pub struct LowModel<'a> {
    file: &'a str,
    parts: Vec<LowPart<'a>>,
    /// Meshes with more than one instance in the scene. The first one is baked.
    pub repeated_meshes: usize,
    /// Primitives without UVs. They are not baked.
    pub without_uvs: usize,
    /// Primitives whose tangents come from the file.
    pub with_own_tangents: usize,
    /// Primitives whose tangents in the file are not those that were baked for.
    pub with_unused_tangents: usize,
    /// The materials of the baked primitives, each once; none for those without a material.
    pub materials: Vec<Option<usize>>,
}

#[derive(Debug)]
struct LowPart<'a> {
    name: PrimitiveName,
    uv_set: usize,
    file: &'a str,
    primitive: PrimitiveInstance<'a>,
    /// Of the instance.
    normals: Cow<'a, [[f32; 3]]>,
    uvs: Cow<'a, [[f32; 2]]>,
    tangents: Vec<[f32; 4]>,
    colors: Option<Cow<'a, [[f32; 4]]>>,
}

impl<'a> LowModel<'a> {
    /// Reads the model. `corners`: [`Document::corners`] of the same document. Errors: invalid data; a
    /// primitive without normals; no triangles with the chosen material; UVs of the chosen set at none of
    /// them.
    pub fn read(
        document: &'a Document,
        corners: &'a [PrimitiveCorners<'a>],
        options: &LowModelOptions,
    ) -> Result<Self, Error> {
        let (instances, materials) = (instances_of_meshes(document)?, document.materials()?);
        let mut model = Self {
            file: document.name(),
            parts: Vec::new(),
            repeated_meshes: 0,
            without_uvs: 0,
            with_own_tangents: 0,
            with_unused_tangents: 0,
            materials: Vec::new(),
        };
        model.repeated_meshes = instances.iter().filter(|instances| instances.len() > 1).count();
        let is_chosen = |corners: &PrimitiveCorners<'_>| {
            options.material.is_none_or(|material| corners.material() == Some(material))
        };
        let with_triangles = || corners.iter().filter(|corners| !corners.is_empty());
        let chosen: Vec<_> = with_triangles().filter(|corners| is_chosen(corners)).collect();
        if let (Some(material), []) = (options.material, &chosen[..]) {
            return Err(without_material(document, material, with_triangles()));
        }
        let mut known_materials = HashSet::new();
        for &corners in &chosen {
            let name = corners.name();
            let Some(instance) = instances.get(name.mesh).and_then(|instances| instances.first()) else {
                continue;
            };
            let Some(primitive) = PrimitiveInstance::read(corners, instance)? else { continue };
            let material = corners.material().and_then(|material| materials.get(material));
            let of_map = material.map_or(0, |material| material.tangent_uv_set);
            let uv_set = options.uv_set.unwrap_or(of_map);
            let Some(mut uvs) = corners.used_vectors(&format!("TEXCOORD_{uv_set}"))? else {
                model.without_uvs += 1;
                continue;
            };
            let Some(normals) = primitive.normals.clone() else {
                return Err(without_normals(document, name));
            };
            let has_own = corners.used_vectors::<4>("TANGENT")?.is_some();
            let is_own = has_own && options.tangents.is_none() && uv_set == of_map;
            model.with_unused_tangents += usize::from(has_own && !is_own);
            if known_materials.insert(corners.material()) {
                model.materials.push(corners.material());
            }
            model.with_own_tangents += usize::from(is_own);
            let stored = StoredPrimitive { document, corners, uvs: &uvs };
            let computed = options.tangents.unwrap_or_default();
            let tangents = stored.tangents((!is_own).then_some(&computed), primitive.transform.as_ref())?;
            if let Some(texture) = material.and_then(|material| material.normal_texture.as_ref())
                && texture.uv_set == uv_set
            {
                uvs.to_mut().iter_mut().for_each(|uv| *uv = texture.transform_uv(*uv));
            }
            let (name, file) = (name.clone(), document.name());
            let colors = colors(document, corners)?;
            model.parts.push(LowPart { name, uv_set, file, primitive, normals, uvs, tangents, colors });
        }
        if model.parts.is_empty() && model.without_uvs > 0 {
            return Err(without_uvs(document, options.uv_set, &chosen));
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

    /// The number of baked primitives whose node, with those above it, mirrors them.
    pub(crate) fn mirrored_count(&self) -> usize {
        let transforms = self.parts.iter().filter_map(|part| part.primitive.transform.as_ref());
        transforms.filter(|transform| transform.orientation() < 0.0).count()
    }

    /// The baked primitives, and the UV set n of `TEXCOORD_n` of each.
    pub fn primitives(&self) -> impl Iterator<Item = (&PrimitiveName, usize)> {
        self.parts.iter().map(|part| (&part.name, part.uv_set))
    }

    /// The name of each surface: that of its node, or else of its mesh; empty if neither has one.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parts.iter().map(|part| &*part.primitive.part_name)
    }

    /// The colours of the vertices of each surface: red, green, blue and alpha; none where the file has none.
    pub fn colors(&self) -> impl Iterator<Item = Option<&[[f32; 4]]>> {
        self.parts.iter().map(|part| part.colors.as_deref())
    }

    /// The name of the document.
    pub fn file(&self) -> &str {
        self.file
    }

    /// Whether another model has the same surfaces, bit for bit, in the same primitives.
    pub fn has_surfaces_of(&self, other: &LowModel<'_>) -> bool {
        let parts = self.parts.iter().zip(&other.parts);
        self.parts.len() == other.parts.len() && parts.into_iter().all(|(part, other)| part.is_equal(other))
    }

    /// The diagonal of the box around the model, in units of its positions.
    pub fn diagonal(&self) -> f64 {
        box_diagonal(self.positions())
    }

    pub(super) fn positions(&self) -> impl Iterator<Item = [f32; 3]> {
        self.parts.iter().flat_map(|part| part.primitive.positions.iter().copied())
    }
}

impl LowPart<'_> {
    fn is_equal(&self, other: &LowPart<'_>) -> bool {
        let places = |part: &LowPart<'_>| (part.name.mesh, part.name.primitive, part.uv_set);
        places(self) == places(other)
            && self.primitive.indices == other.primitive.indices
            && same_bits(&self.primitive.positions, &other.primitive.positions)
            && same_bits(&self.normals, &other.normals)
            && same_bits(&self.uvs, &other.uvs)
            && same_bits(&self.tangents, &other.tangents)
    }

    fn mesh(&self) -> Result<Mesh<'_>, Error> {
        let indices = Indices::U32(&self.primitive.indices);
        Mesh::triangles(&*self.primitive.positions, &*self.normals, &*self.uvs, indices)
            .map_err(|source| Error::Mesh { file: self.file.to_owned(), at: self.name.path(), source })
    }
}

fn same_bits<const N: usize>(a: &[[f32; N]], b: &[[f32; N]]) -> bool {
    let [a, b] = [a, b].map(|rows| rows.as_flattened().iter().map(|x| x.to_bits()));
    a.eq(b)
}

fn without_normals(document: &Document, name: &PrimitiveName) -> Error {
    Error::Unsupported {
        file: document.name().to_owned(),
        at: name.path(),
        problem: "has no normals, which the frames of a normal map need; generate them first".to_owned(),
    }
}

fn without_material<'a>(
    document: &Document,
    material: usize,
    corners: impl Iterator<Item = &'a PrimitiveCorners<'a>>,
) -> Error {
    let materials: BTreeSet<usize> = corners.filter_map(PrimitiveCorners::material).collect();
    let found = match materials.is_empty() {
        true => "; none have a material".to_owned(),
        false => format!("; choose one of {}", listed(materials.iter().map(usize::to_string))),
    };
    Error::Unsupported {
        file: document.name().to_owned(),
        at: String::new(),
        problem: format!("no triangles have materials[{material}]{found}"),
    }
}

fn without_uvs(document: &Document, chosen: Option<usize>, corners: &[&PrimitiveCorners<'_>]) -> Error {
    let of_primitive = |corners: &&PrimitiveCorners<'_>| {
        let name = corners.name();
        let attributes = &document.meshes()[name.mesh].primitives[name.primitive].attributes;
        attributes.keys().filter(|semantic| semantic.starts_with("TEXCOORD_")).cloned().collect::<Vec<_>>()
    };
    let sets: BTreeSet<String> = corners.iter().flat_map(of_primitive).collect();
    let wanted = chosen.map_or("the UVs of their normal map".to_owned(), |set| format!("TEXCOORD_{set}"));
    let problem = match sets.is_empty() {
        true => "no triangles have UVs, onto which to bake; unwrap the model first".to_owned(),
        false => format!("no triangles have {wanted}, onto which to bake; choose one of {}", listed(sets)),
    };
    Error::Unsupported { file: document.name().to_owned(), at: String::new(), problem }
}
